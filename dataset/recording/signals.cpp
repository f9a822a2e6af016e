// SPDX-License-Identifier: MIT
#include "dataset/recording/signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace beamgyro::internal {
namespace {

constexpr Role kTruth = Role::kTruth;

constexpr RecordedSignal kSignals[] = {
    {"output", "V", "voltage at the gyro's pin"},
    {"rate", "degree/s", "uncompensated rate"},
    {"temperature", "degC", "temperature sensor"},
    {"drive_frequency", "Hz", "drive loop frequency"},
    {"drive_voltage", "V", "drive voltage amplitude"},
    {"quadrature", "degree/s", "quadrature channel, rate-equivalent"},
    {"true_rate", "degree/s", "rate about the input axis", kTruth},
    {"true_bias", "degree/s", "zero-rate output of the noise-free twin",
     kTruth},
    {"true_spurious_bias", "degree/s", "part of true_bias by spurious modes",
     kTruth},
    // In single precision a frequency of 9 kHz has steps of 1e-3 Hz.
    {"true_drive_frequency",
     "Hz",
     "drive loop frequency without errors",
     kTruth,
     {},
     true},
    {"true_cross_rate_x", "degree/s", "rate about the x axis", kTruth},
    {"true_cross_rate_y", "degree/s", "rate about the y axis", kTruth},
    {"true_acceleration_x", "m/s2", "acceleration along the x axis", kTruth},
    {"true_acceleration_y", "m/s2", "acceleration along the y axis", kTruth},
    {"true_acceleration_z", "m/s2", "acceleration along the z axis", kTruth},
    {"true_fictive_temperature", "degC", "fictive temperature of the bond",
     kTruth},
    {"true_hysteresis", "1", "hysteresis of the beam, share of the largest",
     kTruth},
    {"true_beam_temperature", "degC", "temperature of the beam", kTruth},
    {"true_pzt_temperature", "degC", "temperature of the pzt", kTruth},
    {"true_mount_temperature", "degC", "temperature of the mount", kTruth},
    {"true_housing_temperature", "degC", "temperature of the housing", kTruth},
    {"true_board_temperature", "degC", "temperature of the board", kTruth},
    {"true_sensor_temperature", "degC", "temperature of the sensor", kTruth},
    {"true_ambient_temperature", "degC", "temperature of air and fixture",
     kTruth, "air_temperature"},
    {"compensated_rate", "degree/s", "rate after compensation",
     Role::kCompensated},
    {"compensated_rate_sigma", "degree/s",
     "1-sigma of the bias of the compensated rate", Role::kCompensated},
};

}  // namespace

std::span<const RecordedSignal> recorded_signals() { return kSignals; }

const RecordedSignal* find_recorded_signal(std::string_view name) {
  const auto* found = std::ranges::find(kSignals, name, &RecordedSignal::name);
  return found == std::end(kSignals) ? nullptr : found;
}

const RecordedSignal& recorded_signal(std::string_view name) {
  const RecordedSignal* found = find_recorded_signal(name);
  if (found == nullptr)
    throw std::logic_error(fmt::format("no signal is called {}", name));
  return *found;
}

Column column_of(std::string_view name, std::vector<double> values) {
  const RecordedSignal& about = recorded_signal(name);
  return {std::string(about.name), std::string(about.units),
          std::string(about.long_name), about.role, std::move(values)};
}

std::string_view unit_of_variable(std::string_view name) {
  if (name == "time") return "s";
  if (name == "status") return "1";
  const RecordedSignal* known = find_recorded_signal(name);
  return known == nullptr ? std::string_view{} : known->units;
}

std::string_view standard_name_of(std::string_view name) {
  if (name == "time" || name == "truth_time") return "time";
  const RecordedSignal* known = find_recorded_signal(name);
  return known == nullptr ? std::string_view{} : known->standard_name;
}

VariableAbout status_about() {
  return {"status", "1", "state of the gyro", Role::kMeasured};
}

std::string source_text(std::string_view fidelity,
                        std::string_view program_version,
                        std::string_view git_revision) {
  const std::string what =
      fidelity == "imported" ? "log of a gyro, imported"
      : fidelity == "csv"
          ? "signals of a gyro, read from CSV"
          : fmt::format("{} simulation of a virtual gyro", fidelity);
  return program_version.empty() ? what
                                 : fmt::format("{} by beamgyro {} ({})", what,
                                               program_version, git_revision);
}

}  // namespace beamgyro::internal
