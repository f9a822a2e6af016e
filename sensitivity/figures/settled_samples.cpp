// SPDX-License-Identifier: MIT
#include "sensitivity/figures/settled_samples.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "config/units.h"
#include "dataset/recording/recording.h"
#include "dataset/recording/signals.h"

namespace beamgyro::internal {
namespace {

// Long for every filter and warm-up.
constexpr double kSettled = 1e7;  // [s]
// Each temperature has a sample without power, which starts the filters anew,
// one at power-on, and one long after.
constexpr Eigen::Index kSamples = 3;

std::vector<double> held(const Eigen::ArrayXd& values) {
  std::vector<double> samples;
  for (const double value : values)
    samples.insert(samples.end(), kSamples, value);
  return samples;
}

Recording settled_recording(const DeviceParameters& device,
                            const StaticCurve& curve) {
  Recording recording;
  for (Eigen::Index k = 0; k < curve.temperature.size(); ++k) {
    const double start = 2 * kSettled * static_cast<double>(k);
    recording.time.insert(recording.time.end(),
                          {start, start + 1, start + kSettled});
    recording.status.insert(recording.status.end(), {kUnpowered, 0, 0});
  }
  const ReadoutParameters& readout = device.readout;
  const auto add = [&](const char* name, const Eigen::ArrayXd& values) {
    recording.columns.push_back(column_of(name, held(values)));
  };
  add("output", curve.bias * (readout.scale_factor * kDegree) + readout.offset);
  add("rate", curve.bias);
  add("temperature", curve.temperature + device.temperature_sensor.offset);
  add("drive_frequency", curve.drive_frequency);
  add("drive_voltage", curve.drive_voltage);
  add("quadrature", curve.quadrature);
  return recording;
}

}  // namespace

Eigen::ArrayXd settled_residual(const Compensator& compensator,
                                const DeviceParameters& device,
                                const StaticCurve& curve) {
  const std::vector<double> rate =
      compensated_rate(compensator, settled_recording(device, curve));
  Eigen::ArrayXd residual(curve.temperature.size());
  for (Eigen::Index k = 0; k < residual.size(); ++k)
    residual(k) = rate[static_cast<std::size_t>(kSamples * (k + 1) - 1)];
  return residual;
}

}  // namespace beamgyro::internal
