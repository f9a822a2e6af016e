// SPDX-License-Identifier: MIT
// The functions of FMI 3.0 that a master binds at load and that this FMU
// refuses: other kinds of FMU, clocks, and types that no variable has.
#include <cstddef>
#include <cstdint>

#include "fmu/c_interface.h"

namespace {

using beamgyro::internal::answered;
using beamgyro::internal::FmuComponent;
using beamgyro::internal::refused;

using Component = void*;
using Reference = std::uint32_t;
using Text = const char*;
using Binary = const std::uint8_t*;
using Count = std::size_t;

constexpr const char* kClocks = "clocks";
constexpr const char* kEvents = "event mode";
constexpr const char* kExchange = "model exchange";

// Gets or sets variables that are none.
int no_variables(Component c, Count count, const char* type) {
  return answered(
      c, [&](FmuComponent&) { beamgyro::internal::require_none(count, type); });
}

}  // namespace

#pragma GCC visibility push(default)
// NOLINTBEGIN(readability-identifier-naming): as the standard has them
extern "C" {

int fmi3GetFloat32(Component c, const Reference*, Count count, float*, Count) {
  return no_variables(c, count, "Float32");
}
int fmi3GetInt8(Component c, const Reference*, Count count, std::int8_t*,
                Count) {
  return no_variables(c, count, "Int8");
}
int fmi3GetUInt8(Component c, const Reference*, Count count, std::uint8_t*,
                 Count) {
  return no_variables(c, count, "UInt8");
}
int fmi3GetInt16(Component c, const Reference*, Count count, std::int16_t*,
                 Count) {
  return no_variables(c, count, "Int16");
}
int fmi3GetUInt16(Component c, const Reference*, Count count, std::uint16_t*,
                  Count) {
  return no_variables(c, count, "UInt16");
}
int fmi3GetUInt32(Component c, const Reference*, Count count, std::uint32_t*,
                  Count) {
  return no_variables(c, count, "UInt32");
}
int fmi3GetInt64(Component c, const Reference*, Count count, std::int64_t*,
                 Count) {
  return no_variables(c, count, "Int64");
}
int fmi3GetString(Component c, const Reference*, Count count, Text*, Count) {
  return no_variables(c, count, "String");
}
int fmi3GetBinary(Component c, const Reference*, Count count, Count*, Binary*,
                  Count) {
  return no_variables(c, count, "Binary");
}
int fmi3GetClock(Component c, const Reference*, Count count, bool*) {
  return no_variables(c, count, "Clock");
}
int fmi3SetFloat32(Component c, const Reference*, Count count, const float*,
                   Count) {
  return no_variables(c, count, "Float32");
}
int fmi3SetInt8(Component c, const Reference*, Count count, const std::int8_t*,
                Count) {
  return no_variables(c, count, "Int8");
}
int fmi3SetUInt8(Component c, const Reference*, Count count,
                 const std::uint8_t*, Count) {
  return no_variables(c, count, "UInt8");
}
int fmi3SetInt16(Component c, const Reference*, Count count,
                 const std::int16_t*, Count) {
  return no_variables(c, count, "Int16");
}
int fmi3SetUInt16(Component c, const Reference*, Count count,
                  const std::uint16_t*, Count) {
  return no_variables(c, count, "UInt16");
}
int fmi3SetUInt32(Component c, const Reference*, Count count,
                  const std::uint32_t*, Count) {
  return no_variables(c, count, "UInt32");
}
int fmi3SetInt64(Component c, const Reference*, Count count,
                 const std::int64_t*, Count) {
  return no_variables(c, count, "Int64");
}
int fmi3SetString(Component c, const Reference*, Count count, const Text*,
                  Count) {
  return no_variables(c, count, "String");
}
int fmi3SetBinary(Component c, const Reference*, Count count, const Count*,
                  const Binary*, Count) {
  return no_variables(c, count, "Binary");
}
int fmi3SetClock(Component c, const Reference*, Count count, const bool*) {
  return no_variables(c, count, "Clock");
}
int fmi3GetNumberOfVariableDependencies(Component c, Reference, Count*) {
  return refused(c, "lists of dependencies");
}
int fmi3GetVariableDependencies(Component c, Reference, Count*, Reference*,
                                Count*, int*, Count) {
  return refused(c, "lists of dependencies");
}
int fmi3GetDirectionalDerivative(Component c, const Reference*, Count,
                                 const Reference*, Count, const double*, Count,
                                 double*, Count) {
  return refused(c, "derivatives");
}
int fmi3GetAdjointDerivative(Component c, const Reference*, Count,
                             const Reference*, Count, const double*, Count,
                             double*, Count) {
  return refused(c, "derivatives");
}
int fmi3GetOutputDerivatives(Component c, const Reference*, Count,
                             const std::int32_t*, double*, Count) {
  return refused(c, "derivatives of outputs");
}
int fmi3EnterConfigurationMode(Component c) {
  return refused(c, "structural parameters");
}
int fmi3ExitConfigurationMode(Component c) {
  return refused(c, "structural parameters");
}
int fmi3EnterEventMode(Component c, bool, bool, const std::int32_t*, Count,
                       bool) {
  return refused(c, kEvents);
}
int fmi3EnterStepMode(Component c) { return refused(c, kEvents); }
int fmi3EvaluateDiscreteStates(Component c) { return refused(c, kEvents); }
int fmi3UpdateDiscreteStates(Component c, bool*, bool*, bool*, bool*, bool*,
                             double*) {
  return refused(c, kEvents);
}
int fmi3GetIntervalDecimal(Component c, const Reference*, Count, double*,
                           int*) {
  return refused(c, kClocks);
}
int fmi3GetIntervalFraction(Component c, const Reference*, Count,
                            std::uint64_t*, std::uint64_t*, int*) {
  return refused(c, kClocks);
}
int fmi3GetShiftDecimal(Component c, const Reference*, Count, double*) {
  return refused(c, kClocks);
}
int fmi3GetShiftFraction(Component c, const Reference*, Count, std::uint64_t*,
                         std::uint64_t*) {
  return refused(c, kClocks);
}
int fmi3SetIntervalDecimal(Component c, const Reference*, Count,
                           const double*) {
  return refused(c, kClocks);
}
int fmi3SetIntervalFraction(Component c, const Reference*, Count,
                            const std::uint64_t*, const std::uint64_t*) {
  return refused(c, kClocks);
}
int fmi3SetShiftDecimal(Component c, const Reference*, Count, const double*) {
  return refused(c, kClocks);
}
int fmi3SetShiftFraction(Component c, const Reference*, Count,
                         const std::uint64_t*, const std::uint64_t*) {
  return refused(c, kClocks);
}
int fmi3ActivateModelPartition(Component c, Reference, double) {
  return refused(c, "scheduled execution");
}
int fmi3EnterContinuousTimeMode(Component c) { return refused(c, kExchange); }
int fmi3CompletedIntegratorStep(Component c, bool, bool*, bool*) {
  return refused(c, kExchange);
}
int fmi3SetTime(Component c, double) { return refused(c, kExchange); }
int fmi3SetContinuousStates(Component c, const double*, Count) {
  return refused(c, kExchange);
}
int fmi3GetContinuousStateDerivatives(Component c, double*, Count) {
  return refused(c, kExchange);
}
int fmi3GetEventIndicators(Component c, double*, Count) {
  return refused(c, kExchange);
}
int fmi3GetContinuousStates(Component c, double*, Count) {
  return refused(c, kExchange);
}
int fmi3GetNominalsOfContinuousStates(Component c, double*, Count) {
  return refused(c, kExchange);
}
int fmi3GetNumberOfEventIndicators(Component c, Count*) {
  return refused(c, kExchange);
}
int fmi3GetNumberOfContinuousStates(Component c, Count*) {
  return refused(c, kExchange);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
#pragma GCC visibility pop
