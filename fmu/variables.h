// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fmu/packed_device.h"
#include "sim/stepper/step_inputs.h"

namespace beamgyro::internal {

enum class VariableType {
  kReal,
  kInteger,
  kBoolean,
  kUnsigned64,  // the seed of FMI 3.0
};
enum class Causality { kIndependent, kParameter, kInput, kOutput, kLocal };

/// Value references: those that have a name here, then the signals in the order
/// of fmu_variables(), then the keys of the device from kFirstKey.
enum KnownReference : std::uint32_t {
  kTimeReference,
  kFirstInput,  // in the order of CaseAxis, then the ambient temperature
  kPowered = kFirstInput + kCaseAxisCount + 1,
  kSeed,      // in FMI 2.0, whose integers have 32 bits, the lower half
  kSeedHigh,  // the upper half, of FMI 2.0 alone
  kNoise,
  kNoiseRate,
  kStirred,
  kAge,
  kStartsAtAmbient,
  kStartTemperature,
  kFirstSignal,
  kFirstKey = 1000,
};
inline constexpr std::size_t kRealInputs = kCaseAxisCount + 1;

/// One variable of the FMU of a device.
struct FmuVariable {
  std::uint32_t reference;
  std::string name;
  VariableType type;
  Causality causality;
  std::string unit = {};         // of a recording; empty: none, or in a key
  std::string description = {};  // empty: that of the signal in recordings
  double start = 0;              // of parameters and inputs
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
};

enum class FmiVersion { k2 = 2, k3 = 3 };

/// Returns all variables of the FMU of a device, in the order of its model
/// description. A signal that the device does not have is left out.
std::vector<FmuVariable> fmu_variables(const PackedDevice& device,
                                       FmiVersion version);

/// The signal of this reference from kFirstSignal, in the unit of a recording.
/// `reference` must be below kFirstSignal + kSignalCount.
double sampled_signal(std::uint32_t reference, const StepSample& sample);

/// The same of the signal `status`, a mask of StatusBit.
inline constexpr std::uint32_t kStatus = kFirstSignal + 6;
std::int32_t status_of(const StepSample& sample);

extern const std::size_t kSignalCount;

}  // namespace beamgyro::internal
