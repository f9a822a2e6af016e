// SPDX-License-Identifier: MIT
// The functions of FMI 2.0, co-simulation, as its standard names and types
// them. Chapters are those of the standard, version 2.0.4.
#include <cstddef>
#include <cstdint>
#include <memory>
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
using beamgyro::internal::refused;
using beamgyro::internal::require_arrays;

using Component = void*;
using Reference = std::uint32_t;
using Text = const char*;

constexpr int kCoSimulation = 1;
// Kinds of status (4.2.3).
constexpr int kLastSuccessfulTime = 2, kTerminated = 3;

// As a master fills it in (2.1.5).
struct CallbackFunctions {
  void (*logger)(void* environment, Text instance, int status, Text category,
                 Text format, ...);
  void* (*allocate_memory)(std::size_t count, std::size_t size);
  void (*free_memory)(void* memory);
  void (*step_finished)(void* environment, int status);
  void* environment;
};

// The master reads a message as a format of printf.
std::string as_format(Text message) {
  std::string format;
  for (; *message != '\0'; ++message) {
    format += *message;
    if (*message == '%') format += '%';
  }
  return format;
}

}  // namespace

#pragma GCC visibility push(default)
// NOLINTBEGIN(readability-identifier-naming): as the standard has them
extern "C" {

Text fmi2GetTypesPlatform() { return "default"; }
Text fmi2GetVersion() { return "2.0"; }

int fmi2SetDebugLogging(Component c, int /*on*/, std::size_t count,
                        const Text* categories) {
  return answered(c, [&](FmuComponent&) {
    beamgyro::internal::require_categories(count, categories);
  });
}

Component fmi2Instantiate(Text name, int type, Text guid, Text resources,
                          const CallbackFunctions* functions, int /*visible*/,
                          int /*logging_on*/) {
  if (functions == nullptr) return nullptr;
  const std::string called = name == nullptr ? "" : name;
  return beamgyro::internal::made_component(
      name, guid, beamgyro::internal::FmiVersion::k2,
      [&] {
        if (type != kCoSimulation)
          throw std::invalid_argument(
              "this FMU has no model exchange; expected co-simulation");
        return beamgyro::internal::folder_of_uri(resources);
      },
      [called, logger = functions->logger,
       environment = functions->environment](Text message) {
        if (logger != nullptr)
          logger(environment, called.c_str(), kFmiError, kErrorCategory,
                 as_format(message).c_str());
      });
}

void fmi2FreeInstance(Component c) { delete static_cast<FmuComponent*>(c); }

int fmi2SetupExperiment(Component c, int /*tolerance_defined*/,
                        double /*tolerance*/, double start, int stop_defined,
                        double stop) {
  return answered(c, [&](FmuComponent& f) {
    f.instance.set_up(start,
                      stop_defined != 0 ? std::optional(stop) : std::nullopt);
  });
}

int fmi2EnterInitializationMode(Component c) {
  return answered(c,
                  [](FmuComponent& f) { f.instance.enter_initialization(); });
}

int fmi2ExitInitializationMode(Component c) {
  return answered(c, [](FmuComponent& f) { f.instance.exit_initialization(); });
}

int fmi2Terminate(Component c) {
  return answered(c, [](FmuComponent& f) { f.instance.terminate(); });
}

int fmi2Reset(Component c) {
  return answered(c, [](FmuComponent& f) { f.instance.reset(); });
}

int fmi2GetReal(Component c, const Reference* references, std::size_t count,
                double* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    f.instance.get_reals({references, count}, values);
  });
}

int fmi2GetInteger(Component c, const Reference* references, std::size_t count,
                   std::int32_t* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    f.instance.get_integers({references, count}, values);
  });
}

int fmi2GetBoolean(Component c, const Reference* references, std::size_t count,
                   int* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    for (const Reference r : std::span(references, count))
      f.instance.get_boolean(r);
    for (std::size_t i = 0; i < count; ++i)
      values[i] = f.instance.get_boolean(references[i]) ? 1 : 0;
  });
}

int fmi2GetString(Component c, const Reference* /*references*/,
                  std::size_t count, Text* /*values*/) {
  return answered(c, [&](FmuComponent&) {
    beamgyro::internal::require_none(count, "String");
  });
}

int fmi2SetReal(Component c, const Reference* references, std::size_t count,
                const double* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    f.instance.set_reals({references, count}, values);
  });
}

int fmi2SetInteger(Component c, const Reference* references, std::size_t count,
                   const std::int32_t* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    f.instance.set_integers({references, count}, values);
  });
}

int fmi2SetBoolean(Component c, const Reference* references, std::size_t count,
                   const int* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, values);
    const auto flags = std::make_unique<bool[]>(count);
    for (std::size_t i = 0; i < count; ++i) flags[i] = values[i] != 0;
    f.instance.set_booleans({references, count}, flags.get());
  });
}

int fmi2SetString(Component c, const Reference* /*references*/,
                  std::size_t count, const Text* /*values*/) {
  return answered(c, [&](FmuComponent&) {
    beamgyro::internal::require_none(count, "String");
  });
}

int fmi2GetFMUstate(Component c, void** state) {
  return answered(c,
                  [&](FmuComponent& f) { f.keep(f.instance.state(), state); });
}

int fmi2SetFMUstate(Component c, void* state) {
  return answered(
      c, [&](FmuComponent& f) { f.instance.set_state(f.held(state)); });
}

int fmi2FreeFMUstate(Component c, void** state) {
  return answered(c, [&](FmuComponent& f) { f.forget(state); });
}

int fmi2SerializedFMUstateSize(Component c, void* state, std::size_t* size) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, size);
    *size = f.instance.bytes_of(f.held(state)).size();
  });
}

int fmi2SerializeFMUstate(Component c, void* state, char* bytes,
                          std::size_t size) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, bytes);
    f.serialise(state, bytes, size);
  });
}

int fmi2DeSerializeFMUstate(Component c, const char* bytes, std::size_t size,
                            void** state) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, bytes, state);
    f.keep(f.instance.state_of({bytes, size}), state);
  });
}

int fmi2GetDirectionalDerivative(Component c, const Reference* /*unknowns*/,
                                 std::size_t /*unknown_count*/,
                                 const Reference* /*knowns*/,
                                 std::size_t /*known_count*/,
                                 const double* /*changes_of_knowns*/,
                                 double* /*changes*/) {
  return refused(c, "directional derivatives");
}

int fmi2SetRealInputDerivatives(Component c, const Reference* references,
                                std::size_t count, const std::int32_t* orders,
                                const double* values) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(count, references, orders, values);
    f.instance.set_slopes({references, count}, orders, values);
  });
}

int fmi2GetRealOutputDerivatives(Component c, const Reference* /*references*/,
                                 std::size_t /*count*/,
                                 const std::int32_t* /*orders*/,
                                 double* /*values*/) {
  return refused(c, "derivatives of outputs");
}

int fmi2DoStep(Component c, double time, double size,
               int /*no_set_state_before*/) {
  return answered(c, [&](FmuComponent& f) { f.instance.step(time, size); });
}

int fmi2CancelStep(Component c) { return refused(c, "steps that wait"); }

int fmi2GetStatus(Component c, int /*kind*/, int* /*value*/) {
  return refused(c, "steps that wait");
}

int fmi2GetRealStatus(Component c, int kind, double* value) {
  return answered(c, [&](FmuComponent& f) {
    require_arrays(1, value);
    if (kind != kLastSuccessfulTime)
      throw std::invalid_argument(
          "the kind of status is no real number; expected "
          "fmi2LastSuccessfulTime");
    *value = f.instance.time();
  });
}

int fmi2GetIntegerStatus(Component c, int /*kind*/, std::int32_t* /*value*/) {
  return refused(c, "status that is an integer");
}

int fmi2GetBooleanStatus(Component c, int kind, int* value) {
  return answered(c, [&](FmuComponent&) {
    require_arrays(1, value);
    if (kind != kTerminated)
      throw std::invalid_argument(
          "the kind of status is no Boolean; expected fmi2Terminated");
    *value = 0;  // it never asks for an end
  });
}

int fmi2GetStringStatus(Component c, int /*kind*/, Text* /*value*/) {
  return refused(c, "status that is a text");
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
#pragma GCC visibility pop
