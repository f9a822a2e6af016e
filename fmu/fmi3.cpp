// SPDX-License-Identifier: MIT
// The functions of FMI 3.0 as its standard names and types them: co-simulation,
// and refusals of what else a master binds at load.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "fmu/c_interface.h"

namespace {

using beamgyro::internal::answered;
using beamgyro::internal::FmuComponent;
using beamgyro::internal::kErrorCategory;
using beamgyro::internal::kFmiError;
using beamgyro::internal::made_component;
using beamgyro::internal::require_arrays;

using Component = void*;
using Reference = std::uint32_t;
using Text = const char*;
using Count = std::size_t;
using Logger = void (*)(void* environment, int status, Text category,
                        Text message);
using IntermediateUpdate = void (*)(void* environment, double time,
                                    bool set_requested, bool get_allowed,
                                    bool step_finished, bool can_return_early,
                                    bool* early_return_requested,
                                    double* early_return_time);
using ClockUpdate = void (*)(void* environment);
using Preemption = void (*)();

std::function<void(Text)> log_of(void* environment, Logger logger) {
  return [environment, logger](Text message) {
    if (logger != nullptr)
      logger(environment, kFmiError, kErrorCategory, message);
  };
}

Component refused_kind(const char* kind, void* environment, Logger logger) {
  log_of(environment, logger)(
      (std::string("this FMU has no ") + kind + "; expected co-simulation")
          .c_str());
  return nullptr;
}

void require_scalars(Count count, Count values) {
  if (count != values)
    throw std::invalid_argument(
        "there are more or fewer values than value references; expected as "
        "many, as every variable is a scalar");
}

}  // namespace

#pragma GCC visibility push(default)
// NOLINTBEGIN(readability-identifier-naming): as the standard has them
extern "C" {

Text fmi3GetVersion() { return "3.0"; }

int fmi3SetDebugLogging(Component c, bool /*on*/, Count count,
                        const Text* categories) {
  return answered(c, [&](FmuComponent&) {
    beamgyro::internal::require_categories(count, categories);
  });
}

Component fmi3InstantiateCoSimulation(
    Text name, Text token, Text resources, bool /*visible*/,
    bool /*logging_on*/, bool event_mode_used, bool /*early_return_allowed*/,
    const Reference* /*intermediate*/, Count intermediate_count,
    void* environment, Logger logger, IntermediateUpdate /*update*/) {
  return made_component(
      name, token, beamgyro::internal::FmiVersion::k3,
      [&]() -> std::string {
        if (event_mode_used || intermediate_count > 0)
          throw std::invalid_argument(
              "this FMU has no event mode and no intermediate updates; "
              "expected an instance without");
        if (resources == nullptr)
          throw std::invalid_argument(
              "the path of the resources is missing; expected their folder");
        return resources;
      },
      log_of(environment, logger));
}

Component fmi3InstantiateModelExchange(Text /*name*/, Text /*token*/,
                                       Text /*resources*/, bool /*visible*/,
                                       bool /*logging_on*/, void* environment,
                                       Logger logger) {
  return refused_kind("model exchange", environment, logger);
}

Component fmi3InstantiateScheduledExecution(
    Text /*name*/, Text /*token*/, Text /*resources*/, bool /*visible*/,
    bool /*logging_on*/, void* environment, Logger logger,
    ClockUpdate /*update*/, Preemption /*lock*/, Preemption /*unlock*/) {
  return refused_kind("scheduled execution", environment, logger);
}

void fmi3FreeInstance(Component c) { delete static_cast<FmuComponent*>(c); }

int fmi3EnterInitializationMode(Component c, bool /*tolerance_defined*/,
                                double /*tolerance*/, double start,
                                bool stop_defined, double stop) {
  return answered(c, [&](FmuComponent& f) {
    f.instance.set_up(start, stop_defined ? std::optional(stop) : std::nullopt);
    f.instance.enter_initialization();
  });
}

int fmi3ExitInitializationMode(Component c) {
  return answered(c, [](FmuComponent& f) { f.instance.exit_initialization(); });
}

int fmi3Terminate(Component c) {
  return answered(c, [](FmuComponent& f) { f.instance.terminate(); });
}

int fmi3Reset(Component c) {
  return answered(c, [](FmuComponent& f) { f.instance.reset(); });
}

int fmi3DoStep(Component c, double time, double size,
               bool /*no_set_state_before*/, bool* event_handling_needed,
               bool* terminate, bool* early_return, double* last_time) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, event_handling_needed, terminate, early_return,
                   last_time);
    f.instance.step(time, size);
    *event_handling_needed = *terminate = *early_return = false;
    *last_time = f.instance.time();
  });
}

int fmi3GetFloat64(Component c, const Reference* references, Count count,
                   double* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    f.instance.get_reals({references, count}, values);
  });
}

int fmi3GetInt32(Component c, const Reference* references, Count count,
                 std::int32_t* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    f.instance.get_integers({references, count}, values);
  });
}

int fmi3GetUInt64(Component c, const Reference* references, Count count,
                  std::uint64_t* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    for (const Reference r : std::span(references, count))
      f.instance.get_unsigned64(r);
    for (Count i = 0; i < count; ++i)
      values[i] = f.instance.get_unsigned64(references[i]);
  });
}

int fmi3GetBoolean(Component c, const Reference* references, Count count,
                   bool* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    for (const Reference r : std::span(references, count))
      f.instance.get_boolean(r);
    for (Count i = 0; i < count; ++i)
      values[i] = f.instance.get_boolean(references[i]);
  });
}

int fmi3SetFloat64(Component c, const Reference* references, Count count,
                   const double* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    f.instance.set_reals({references, count}, values);
  });
}

int fmi3SetInt32(Component c, const Reference* references, Count count,
                 const std::int32_t* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    f.instance.set_integers({references, count}, values);
  });
}

int fmi3SetUInt64(Component c, const Reference* references, Count count,
                  const std::uint64_t* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    // There is one variable of this type: the last value counts.
    for (Count i = 0; i < count; ++i) f.instance.get_unsigned64(references[i]);
    for (Count i = 0; i < count; ++i)
      f.instance.set_unsigned64(references[i], values[i]);
  });
}

int fmi3SetBoolean(Component c, const Reference* references, Count count,
                   const bool* values, Count value_count) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    require_scalars(count, value_count);
    f.instance.set_booleans({references, count}, values);
  });
}

int fmi3GetFMUState(Component c, void** state) {
  return answered(c,
                  [&](FmuComponent& f) { f.keep(f.instance.state(), state); });
}

int fmi3SetFMUState(Component c, void* state) {
  return answered(
      c, [&](FmuComponent& f) { f.instance.set_state(f.held(state)); });
}

int fmi3FreeFMUState(Component c, void** state) {
  return answered(c, [&](FmuComponent& f) { f.forget(state); });
}

int fmi3SerializedFMUStateSize(Component c, void* state, Count* size) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, size);
    *size = f.instance.bytes_of(f.held(state)).size();
  });
}

int fmi3SerializeFMUState(Component c, void* state, std::uint8_t* bytes,
                          Count size) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, bytes);
    f.serialise(state, bytes, size);
  });
}

int fmi3DeserializeFMUState(Component c, const std::uint8_t* bytes, Count size,
                            void** state) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, bytes, state);
    f.keep(f.instance.state_of({reinterpret_cast<const char*>(bytes), size}),
           state);
  });
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
#pragma GCC visibility pop
