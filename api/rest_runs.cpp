// SPDX-License-Identifier: MIT
#include "api/rest_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "api/scenario_state.h"
#include "include/beamgyro/simulate.h"

namespace beamgyro::internal {
namespace {

// A run at rest without noise.
RestCurve rest_run(const Device& device, const std::string& scenario,
                   double rate, double duration,
                   std::vector<std::string>& warnings) {
  const SimulatedRun run = simulate(Scenario::parse(
      fmt::format("name = \"export\"\ndevice = \"\"\nseed = 0\n"
                  "fidelity = \"quasistatic\"\nduration_s = {:.17g}\n"
                  "output_rate_Hz = {:.17g}\nnoise.enabled = false\n{}",
                  duration, rate, scenario),
      device));
  for (const std::string& warning : run.warnings)
    warnings.push_back(fmt::format("{}: {}", device.name(), warning));
  RestCurve curve{run.recording.time,
                  column_values(run.recording, "true_sensor_temperature"),
                  column_values(run.recording, "true_bias")};
  const double offset = device.content().device.temperature_sensor.offset;
  for (double& T : curve.temperature) T += offset;
  return curve;
}

}  // namespace

RestCurve warm_up_run(const Device& device, double ambient,
                      std::vector<std::string>& warnings) {
  const std::string scenario =
      fmt::format("ambient.constant_degC = {:.17g}\n", ambient);
  constexpr double kHour = 3600, kSamples = 3600, kStillMoves = 0.02;
  constexpr double kNoRise = 0.1;  // [K]
  for (const double hours : {1.0, 10.0}) {
    std::vector<std::string> said;
    RestCurve curve = rest_run(device, scenario, kSamples / (hours * kHour),
                               hours * kHour, said);
    const std::vector<double>& T = curve.temperature;
    const double late = T.back() - T[T.size() - T.size() / 10];
    if (hours > 1 ||
        std::abs(late) <= kStillMoves * std::abs(T.back() - T.front()) ||
        std::abs(T.back() - T.front()) < kNoRise) {
      warnings.insert(warnings.end(), said.begin(), said.end());
      return curve;
    }
  }
  return {};  // not reached
}

RestCurve swept_soaks(const Device& device, std::pair<double, double> range,
                      double hold, std::vector<std::string>& warnings) {
  constexpr double kStep = 5, kRamp = 600, kMinute = 60;
  const double span = range.second - range.first;
  const int steps = std::max(6, static_cast<int>(std::ceil(span / kStep)));
  hold = kMinute * std::ceil(hold / kMinute);
  std::string points;
  std::vector<std::size_t> ends;
  double time = 0;
  for (int k = 0; k <= steps; ++k) {
    const double T = range.first + span * k / steps;
    points += fmt::format("[{:.17g}, {:.17g}], [{:.17g}, {:.17g}],", time, T,
                          time + hold, T);
    ends.push_back(static_cast<std::size_t>((time + hold) / kMinute));
    time += hold + kRamp;
  }
  const RestCurve run =
      rest_run(device, fmt::format("ambient.points = [{}]\n", points),
               1 / kMinute, time, warnings);
  RestCurve curve;
  for (const std::size_t k : ends) {
    curve.time.push_back(run.time.at(k));
    curve.temperature.push_back(run.temperature.at(k));
    curve.bias.push_back(run.bias.at(k));
  }
  return curve;
}

}  // namespace beamgyro::internal
