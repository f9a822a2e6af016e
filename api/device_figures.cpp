// SPDX-License-Identifier: MIT
#include "api/device_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/rest_runs.h"
#include "api/scenario_state.h"
#include "include/beamgyro/allan.h"
#include "include/beamgyro/simulate.h"
#include "validation/metrics/frequency_response.h"

namespace beamgyro::internal {
namespace {

constexpr double kRoom = 25;  // [degC]

const std::vector<double>& values_of(const Characteristic& found,
                                     const std::string& name) {
  return std::ranges::find(found.columns, name, &CharacteristicColumn::name)
      ->values;
}

Recording rest_hour(const Device& device, bool has_noise) {
  return simulate(
             Scenario::parse(
                 fmt::format("name = \"noise\"\ndevice = \"\"\nseed = 1\n"
                             "fidelity = \"quasistatic\"\nduration_s = 3600\n"
                             "output_rate_Hz = 10\nambient.constant_degC = {}\n"
                             "noise.enabled = {}\n",
                             kRoom, has_noise),
                 device))
      .recording;
}

}  // namespace

SteadyFigures steady_figures(const Device& device) {
  const Characteristic found = characterise(device, std::vector{kRoom});
  const auto at_room = [&](const char* name) {
    return values_of(found, name).at(0);
  };
  return {at_room("drive_frequency"), at_room("split"), at_room("q_drive"),
          at_room("drive_voltage")};
}

double bias_over(const Device& device, std::pair<double, double> range) {
  constexpr int kSteps = 90;
  std::vector<double> temperatures;
  for (int k = 0; k <= kSteps; ++k)
    temperatures.push_back(range.first +
                           (range.second - range.first) * k / kSteps);
  const Characteristic found = characterise(device, temperatures);
  const auto [low, high] = std::ranges::minmax(values_of(found, "bias"));
  return high - low;
}

WarmUpFigures warm_up_figures(const Device& device) {
  constexpr double kShare = 0.95;
  std::vector<std::string> ignored;
  const RestCurve run = warm_up_run(device, kRoom, ignored);
  const std::vector<double>& T = run.temperature;
  const double offset = device.content().device.temperature_sensor.offset;
  const double level = T.front() + kShare * (T.back() - T.front());
  std::size_t k = 1;
  while (k + 1 < T.size() && (T[k] < level) == (T.front() < level)) ++k;
  const double part =
      T[k] == T[k - 1] ? 0 : (level - T[k - 1]) / (T[k] - T[k - 1]);
  return {T.back() - offset - kRoom,
          run.time[k - 1] + part * (run.time[k] - run.time[k - 1])};
}

std::optional<double> noise_figure(const Device& device) {
  const Recording noisy = rest_hour(device, true);
  const Recording clean = rest_hour(device, false);
  std::vector<double> noise = column_values(noisy, "rate");
  const std::vector<double>& drift = column_values(clean, "rate");
  for (std::size_t k = 0; k < noise.size(); ++k) noise[k] -= drift[k];
  for (const NoiseCoefficient& one : allan(noise, 10.0).coefficients)
    if (one.symbol == 'N') return one.value;
  return std::nullopt;
}

ResponseFigures response_figures(const Device& device) {
  constexpr double kHighest = 800, kLowest = 0.5;  // [Hz]
  const double rate =
      0.2 * device.content().device.readout.full_scale * 180 / std::numbers::pi;
  const Recording run =
      simulate(Scenario::parse(
                   fmt::format("name = \"step\"\ndevice = \"\"\nseed = 1\n"
                               "fidelity = \"envelope\"\nduration_s = 4\n"
                               "output_rate_Hz = 2000\n"
                               "ambient.constant_degC = {}\n"
                               "rate.steps = [[0, 0], [2, {:.17g}]]\n"
                               "noise.enabled = false\n",
                               kRoom, rate),
                   device))
          .recording;
  std::vector<double> frequencies;
  constexpr int kSteps = 400;
  for (int k = 0; k <= kSteps; ++k)
    frequencies.push_back(kLowest * std::pow(kHighest / kLowest,
                                             static_cast<double>(k) / kSteps));
  const std::vector<ResponsePoint> points =
      step_response(run, column_values(run, "rate"), frequencies);
  const double half = std::numbers::sqrt2 / 2;
  ResponseFigures found;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double before = std::abs(points[k - 1].gain);
    const double after = std::abs(points[k].gain);
    if (after > found.peak)
      found.peak = after, found.peak_frequency = points[k].frequency;
    if (after <= half && !found.bandwidth)
      found.bandwidth = std::lerp(points[k - 1].frequency, points[k].frequency,
                                  (before - half) / (before - after));
  }
  return found;
}

}  // namespace beamgyro::internal
