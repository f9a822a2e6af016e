// SPDX-License-Identifier: MIT
#include "tests/validation/metrics/metric_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/signal/noise.h"

namespace beamgyro::internal {
namespace {

std::vector<double>& rate_of(Recording& recording) {
  for (Column& column : recording.columns)
    if (column.name == "rate") return column.values;
  throw std::logic_error("no rate");
}

/// Noise of the simulator, in deg/s: its law is the same in every unit.
void add_noise(const NoiseLevels& levels, std::uint64_t seed,
               std::uint32_t number, Recording& recording) {
  NoiseParameters parameters{levels.angle_random_walk, levels.bias_instability,
                             levels.rate_random_walk, levels.turn_on,
                             levels.turn_on_transient};
  if (levels.turn_on_transient > 0.0) {
    parameters.turn_on_settling = levels.turn_on_settling;
    parameters.turn_on_recovery = levels.turn_on_recovery;
  }
  const double step = recording.time[1] - recording.time[0];
  std::vector<double>& rate = rate_of(recording);
  RateNoise(parameters, 1.0 / step, seed, 0, number).add_next(rate);
  const auto stretches = powered_stretches(recording);
  const std::vector<double> offsets =
      turn_on_offsets(parameters, stretches.size(), seed, 0, number);
  std::vector<double> off_times(stretches.size(), HUGE_VAL);
  for (std::size_t i = 1; i < stretches.size(); ++i)
    off_times[i] = recording.time[stretches[i].begin] -
                   recording.time[stretches[i - 1].end - 1];
  const std::vector<double> transients =
      turn_on_transients(parameters, off_times, seed, 0, number);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double on = recording.time[stretches[i].begin];
    for (std::size_t k = stretches[i].begin; k < stretches[i].end; ++k)
      rate[k] +=
          offsets[i] + transients[i] * std::exp((on - recording.time[k]) /
                                                parameters.turn_on_settling);
  }
  recording.device_text = fmt::format(
      "[noise]\nangle_random_walk_deg_per_sqrt_s = {}\n"
      "bias_instability_deg_per_s = {}\n"
      "rate_random_walk_deg_per_s_per_sqrt_s = {}\nturn_on_deg_per_s = {}\n"
      "turn_on_transient_deg_per_s = {}\nturn_on_settling_s = {}\n"
      "turn_on_recovery_s = {}\n",
      levels.angle_random_walk, levels.bias_instability,
      levels.rate_random_walk, levels.turn_on, levels.turn_on_transient,
      parameters.turn_on_settling, parameters.turn_on_recovery);
  recording.scenario_text = "[noise]\nenabled = true\n";
}

}  // namespace

EvidenceRun& Scene::add(const SceneRun& run, const NoiseLevels& noise,
                        std::uint64_t seed) {
  Recording recording = run.signals.recording();
  recording.fidelity = "quasistatic";
  for (const auto& [name, signal] : run.truths) {
    std::vector<double> values;
    for (const double t : recording.time) values.push_back(signal(t));
    recording.columns.push_back({name, "", name, Role::kTruth, values});
  }
  if (noise != NoiseLevels{})
    add_noise(noise, seed, static_cast<std::uint32_t>(recordings_.size()),
              recording);
  return add(run.purpose, std::move(recording));
}

EvidenceRun& Scene::add(RunPurpose purpose, Recording recording) {
  recordings_.push_back(std::make_unique<Recording>(std::move(recording)));
  return evidence.runs.emplace_back(EvidenceRun{
      fmt::format("run {}", recordings_.size()), purpose,
      recordings_.back().get(), column_values(*recordings_.back(), "rate")});
}

Estimate evaluated(const std::string& metric, const Evidence& evidence) {
  const Metric* found = find_metric(metric);
  if (found == nullptr) {
    ADD_FAILURE() << "no metric " << metric;
    return {};
  }
  const std::optional<Estimate> value = found->evaluate(evidence);
  EXPECT_TRUE(value.has_value()) << metric << " is not shown";
  return value.value_or(Estimate{});
}

SignalOfTime soak_temperatures(std::vector<double> temperatures, double hold) {
  return [temperatures = std::move(temperatures), hold](double t) {
    constexpr double kSlope = 300.0;  // [s]
    const double place = t / (hold + kSlope);
    const auto j =
        std::min(static_cast<std::size_t>(place), temperatures.size() - 1);
    const double left = t - static_cast<double>(j) * (hold + kSlope) - hold;
    if (left <= 0.0 || j + 1 == temperatures.size()) return temperatures[j];
    return temperatures[j] +
           left / kSlope * (temperatures[j + 1] - temperatures[j]);
  };
}

double ramp_temperature(double t) {
  const double up = std::clamp((t - 600.0) / 60.0, 0.0, 60.0);
  return -20.0 + up - std::clamp((t - 4800.0) / 60.0, 0.0, 60.0);
}

double table_rate(double t) {
  const int step = static_cast<int>(t / 20);
  return 20.0 * (step < 11 ? step : 21 - step) - 100.0;
}

SceneRun tumble_run(double drift, const std::array<double, 3>& sensitivities) {
  const auto axis = [](int number) {
    return [number](double t) {
      const int hold = static_cast<int>(t / 60);
      if (hold / 8 != number) return 0.0;
      return hold % 2 == 0 ? kStandardGravity : -kStandardGravity;
    };
  };
  const auto bias = [drift, sensitivities, axis](double t) {
    double sum = 0.0;
    for (int j = 0; j < 3; ++j)
      sum += sensitivities[static_cast<std::size_t>(j)] * axis(j)(t);
    return 0.3 + drift * t + sum / kStandardGravity;
  };
  return {RunPurpose::kTumble,
          {.duration = 1440, .step = 1, .bias = bias},
          {{"true_acceleration_x", axis(0)},
           {"true_acceleration_y", axis(1)},
           {"true_acceleration_z", axis(2)}}};
}

}  // namespace beamgyro::internal
