// SPDX-License-Identifier: MIT
#include "fmu/variables.h"

#include <iterator>
#include <limits>

#include "include/beamgyro/recording.h"

namespace beamgyro::internal {
namespace {

using Type = VariableType;

constexpr double kMostRate = 1e4;                            // [deg/s]
constexpr double kMostAcceleration = 1e6;                    // [m/s2]
constexpr double kColdestInput = -100, kHottestInput = 150;  // [degC]
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kHalf = 2147483648.0;  // 2^31

// A signal of samples. Which devices have it, where not all do.
struct SampledSignal {
  const char* name;
  double (*value)(const StepSample&);
  bool (*is_there)(const DeviceParameters&) = nullptr;
};

template <double StepSample::*kMember>
double member(const StepSample& sample) {
  return sample.*kMember;
}
template <std::size_t kNode>
double node(const StepSample& sample) {
  return sample.true_node_temperature[kNode];
}

// The first seven are outputs. A new signal goes to the end.
constexpr std::size_t kOutputs = 7;
constexpr SampledSignal kSampledSignals[] = {
    {"output", member<&StepSample::output>},
    {"rate", member<&StepSample::rate>},
    {"temperature", member<&StepSample::temperature>},
    {"drive_frequency", member<&StepSample::drive_frequency>},
    {"drive_voltage", member<&StepSample::drive_voltage>},
    {"quadrature", member<&StepSample::quadrature>},
    {"status", [](const StepSample& s) -> double { return status_of(s); }},
    {"true_bias", member<&StepSample::true_bias>},
    {"true_spurious_bias", member<&StepSample::true_spurious_bias>,
     [](const DeviceParameters& d) { return !d.spurious_modes.empty(); }},
    {"true_drive_frequency", member<&StepSample::true_drive_frequency>},
    {"true_acceleration_x", member<&StepSample::true_acceleration_x>},
    {"true_acceleration_y", member<&StepSample::true_acceleration_y>},
    {"true_acceleration_z", member<&StepSample::true_acceleration_z>},
    {"true_fictive_temperature", member<&StepSample::true_fictive_temperature>,
     [](const DeviceParameters& d) { return d.memory.relaxation.has_value(); }},
    {"true_hysteresis", member<&StepSample::true_hysteresis>,
     [](const DeviceParameters& d) { return d.memory.hysteresis.has_value(); }},
    {"true_beam_temperature", node<kBeam>},
    {"true_pzt_temperature", node<kPzt>},
    {"true_mount_temperature", node<kMount>},
    {"true_housing_temperature", node<kHousing>},
    {"true_board_temperature", node<kBoard>},
    {"true_sensor_temperature", node<kSensor>},
    {"true_ambient_temperature", member<&StepSample::true_ambient_temperature>},
};

void add_inputs(std::vector<FmuVariable>& all) {
  const auto add = [&](const char* name, const char* unit, const char* what,
                       double most) {
    all.push_back({.reference = static_cast<std::uint32_t>(all.size()),
                   .name = name,
                   .type = Type::kReal,
                   .causality = Causality::kInput,
                   .unit = unit,
                   .description = what,
                   .low = -most,
                   .high = most});
  };
  all.push_back({kTimeReference, "time", Type::kReal, Causality::kIndependent,
                 "s", "time of the simulation"});
  // In the order of CaseAxis.
  add("true_rate", "degree/s", "rate about the input axis z", kMostRate);
  add("true_cross_rate_x", "degree/s", "rate about the x axis", kMostRate);
  add("true_cross_rate_y", "degree/s", "rate about the y axis", kMostRate);
  add("acceleration_x", "m/s2", "acceleration along the x axis",
      kMostAcceleration);
  add("acceleration_y", "m/s2", "acceleration along the y axis",
      kMostAcceleration);
  add("acceleration_z", "m/s2", "acceleration along the z axis",
      kMostAcceleration);
  add("ambient_temperature", "degC", "temperature of air and fixture", 0);
  all.back().start = 25;
  all.back().low = kColdestInput;
  all.back().high = kHottestInput;
  all.push_back({kPowered, "powered", Type::kBoolean, Causality::kInput, "",
                 "whether the supply is on", 1});
}

void add_start(FmiVersion version, std::vector<FmuVariable>& all) {
  const auto add = [&](std::uint32_t reference, const char* name, Type type,
                       const char* unit, const char* what, double start,
                       double low, double high) {
    all.push_back({reference, name, type, Causality::kParameter, unit, what,
                   start, low, high});
  };
  if (version == FmiVersion::k2) {
    add(kSeed, "seed", Type::kInteger, "",
        "seed of everything random, the lower 32 of its 64 bits", 0, -kHalf,
        kHalf - 1);
    add(kSeedHigh, "seed_high", Type::kInteger, "", "its upper 32 bits", 0,
        -kHalf, kHalf - 1);
  } else {
    add(kSeed, "seed", Type::kUnsigned64, "", "seed of everything random", 0, 0,
        kInfinite);
  }
  add(kNoise, "noise", Type::kBoolean, "", "whether there is noise", 1, 0, 1);
  add(kNoiseRate, "noise_rate", Type::kReal, "Hz",
      "rate at which the noise changes; 0: one over the first step", 0, 0, 1e6);
  add(kStirred, "stirred", Type::kBoolean, "",
      "whether a fan moves the air of a chamber", 0, 0, 1);
  add(kAge, "age", Type::kReal, "h", "age since the factory trim at the start",
      0, 0, 1e9 / 3600);
  add(kStartsAtAmbient, "starts_at_ambient", Type::kBoolean, "",
      "whether every part starts at the ambient temperature", 1, 0, 1);
  add(kStartTemperature, "start_temperature", Type::kReal, "degC",
      "temperature of every part at the start, unless starts_at_ambient", 25,
      kColdestInput, kHottestInput);
}

void add_signals(const DeviceParameters& device,
                 std::vector<FmuVariable>& all) {
  for (std::uint32_t i = 0; i < std::size(kSampledSignals); ++i) {
    const SampledSignal& signal = kSampledSignals[i];
    if (signal.is_there != nullptr && !signal.is_there(device)) continue;
    const std::uint32_t reference = kFirstSignal + i;
    all.push_back(
        {.reference = reference,
         .name = signal.name,
         .type = reference == kStatus ? Type::kInteger : Type::kReal,
         .causality = i < kOutputs ? Causality::kOutput : Causality::kLocal});
  }
}

}  // namespace

const std::size_t kSignalCount = std::size(kSampledSignals);

double sampled_signal(std::uint32_t reference, const StepSample& sample) {
  return kSampledSignals[reference - kFirstSignal].value(sample);
}

std::int32_t status_of(const StepSample& sample) {
  if (!sample.powered) return kUnpowered;
  return (sample.saturated ? kOutputSaturated : 0) |
         (sample.locked ? 0 : kLoopNotLocked);
}

std::vector<FmuVariable> fmu_variables(const PackedDevice& device,
                                       FmiVersion version) {
  std::vector<FmuVariable> all;
  add_inputs(all);
  add_start(version, all);
  add_signals(device.parameters(), all);
  std::uint32_t reference = kFirstKey;
  for (const DeviceKey& key : device.keys())
    all.push_back({.reference = reference++,
                   .name = key.name,
                   .type = key.whole ? Type::kInteger : Type::kReal,
                   .causality = Causality::kParameter,
                   .description = "key of the device file",
                   .start = key.value,
                   .low = key.range.low,
                   .high = key.range.high,
                   .low_open = key.range.low_open,
                   .high_open = key.range.high_open});
  return all;
}

}  // namespace beamgyro::internal
