// SPDX-License-Identifier: MIT
#include "tests/dataset/sample_recording.h"

#include <limits>

namespace beamgyro::internal {
namespace {

struct Variable {
  const char* name;
  const char* units;
  const char* long_name;
  Role role;
};

constexpr Variable kVariables[] = {
    {"output", "V", "gyro output", Role::kMeasured},
    {"rate", "degree/s", "uncompensated rate", Role::kMeasured},
    {"temperature", "degC", "temperature sensor", Role::kMeasured},
    {"drive_frequency", "Hz", "drive frequency", Role::kMeasured},
    {"drive_voltage", "V", "drive voltage", Role::kMeasured},
    {"quadrature", "degree/s", "quadrature", Role::kMeasured},
    {"true_rate", "degree/s", "rate about the input axis", Role::kTruth},
    {"true_bias", "degree/s", "bias", Role::kTruth},
    {"true_beam_temperature", "degC", "beam", Role::kTruth},
    {"true_pzt_temperature", "degC", "pzt", Role::kTruth},
    {"true_mount_temperature", "degC", "mount", Role::kTruth},
    {"true_housing_temperature", "degC", "housing", Role::kTruth},
    {"true_board_temperature", "degC", "board", Role::kTruth},
    {"true_sensor_temperature", "degC", "sensor", Role::kTruth},
    {"true_ambient_temperature", "degC", "ambient", Role::kTruth},
    {"compensated_rate", "degree/s", "", Role::kCompensated},
};

}  // namespace

Recording sample_recording(std::size_t samples) {
  Recording recording;
  for (std::size_t k = 0; k < samples; ++k) {
    recording.time.push_back(static_cast<double>(k) / 10.0);
    recording.status.push_back(k < samples / 5 ? kUnpowered : 0);
  }
  if (samples > 2) {
    recording.status[samples - 1] = kOutputSaturated;
    recording.status[samples - 2] = kLoopNotLocked | kOutputSaturated;
  }
  double factor = 1.0;
  for (const Variable& variable : kVariables) {
    Column column{
        variable.name, variable.units, variable.long_name, variable.role, {}};
    for (std::size_t k = 0; k < samples; ++k) {
      const bool is_off = (recording.status[k] & kUnpowered) != 0;
      column.values.push_back(is_off && variable.role != Role::kTruth
                                  ? std::numeric_limits<double>::quiet_NaN()
                                  : factor * static_cast<double>(k) / 8 - 3);
    }
    recording.columns.push_back(std::move(column));
    factor += 1.0;
  }
  recording.fidelity = "quasistatic";
  recording.seed = 18446744073709551615u;  // the largest there is
  recording.title = "a sample";
  recording.history = "made\ncompensated";
  recording.compensator = "c.json";
  recording.compensator_sha256 = "0123";
  recording.program_version = "1.2.3";
  recording.git_revision = "0123abc";
  recording.scenario_text =
      "name = \"Gr\xc3\xbc\xc3\x9f"
      "e\"\r\n\tx = 1";
  recording.device_text = "[beam]\nlength_m = 0.04\n";
  recording.overrides_text = "";
  return recording;
}

}  // namespace beamgyro::internal
