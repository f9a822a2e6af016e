// SPDX-License-Identifier: MIT
#include "sim/scenario/run_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <variant>

#include "config/units.h"
#include "sim/scenario/drive_lock.h"
#include "sim/thermal/material_range.h"

namespace beamgyro {
namespace {

/// The apparent frequency of a sine that is sampled at `rate`.
double alias_of(double frequency, double rate) {
  return std::abs(frequency - rate * std::round(frequency / rate));
}

/// The times within [0, duration) at which a motion turns back.
std::vector<double> turns_of(const PiecewiseLinear& motion, double duration) {
  std::vector<double> turns;
  double direction = 0;
  const std::vector<double>&time = motion.times(), &value = motion.values();
  for (std::size_t k = 1; k < time.size() && time[k - 1] < duration; ++k) {
    const double step = value[k] - value[k - 1];
    if (step == 0) continue;
    if (direction * step < 0) turns.push_back(time[k - 1]);
    direction = step;
  }
  return turns;
}

/// A motion of one axis, as files name it.
struct NamedMotion {
  std::string key;
  const RateProfile& profile;
};

std::vector<NamedMotion> motions_of(const Scenario& scenario) {
  std::vector<NamedMotion> motions = {{"rate", scenario.rate}};
  constexpr std::string_view kAxisNames[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < scenario.cross_rate.size(); ++i)
    motions.push_back(
        {fmt::format("cross_rate.{}", kAxisNames[i]), scenario.cross_rate[i]});
  for (std::size_t i = 0; i < scenario.acceleration.size(); ++i)
    motions.push_back({fmt::format("acceleration.{}", kAxisNames[i]),
                       scenario.acceleration[i]});
  return motions;
}

std::string aliasing_of(const NamedMotion& motion, const Scenario& scenario) {
  const double rate = scenario.output_rate;
  if (!moves(motion.profile)) return {};
  if (const auto* sine = std::get_if<SineSignal>(&motion.profile)) {
    if (sine->amplitude == 0 || sine->frequency <= rate / 2) return {};
    return fmt::format(
        "{}.sine.frequency_Hz = {:g} is above half of output_rate_Hz = {:g}: "
        "the {} samples show it as {:.4g} Hz",
        motion.key, sine->frequency, rate, sample_count(scenario),
        alias_of(sine->frequency, rate));
  }
  if (const auto* random = std::get_if<RandomRate>(&motion.profile)) {
    if (random->bandwidth <= rate / 2) return {};
    return fmt::format(
        "{}.random.bandwidth_Hz = {:g} is above half of output_rate_Hz = {:g}: "
        "the {} samples show what is faster as slower",
        motion.key, random->bandwidth, rate, sample_count(scenario));
  }
  const std::vector<double> turns =
      turns_of(std::get<PiecewiseLinear>(motion.profile), scenario.duration);
  std::size_t fast = 0;
  for (std::size_t k = 1; k < turns.size(); ++k)
    if (turns[k] - turns[k - 1] < (1 - 1e-9) / rate) ++fast;
  if (fast == 0) return {};
  return fmt::format(
      "{}: {} of {} swings of the profile are shorter than the {:g} s between "
      "samples: output_rate_Hz = {:g} shows them as slower ones",
      motion.key, fast, turns.size() - 1, 1 / rate, rate);
}

std::string soaks_text(const Scenario& scenario) {
  const std::vector<double>& ends = scenario.soak_ends;
  const auto cut = std::ranges::count_if(ends, [&](double end) {
    return end > scenario.duration && !is_same_time(end, scenario.duration);
  });
  if (cut == 0) return {};
  return fmt::format(
      "ambient.soaks: duration_s = {:g} cuts {} of {} soaks; the last ends at "
      "{:g} s",
      scenario.duration, cut, ends.size(), ends.back());
}

std::string share(std::size_t count, std::size_t all) {
  return count == all ? fmt::format("all {}", all)
                      : fmt::format("{} of {}", count, all);
}

}  // namespace

std::vector<std::string> aliasing_warnings(const Scenario& scenario) {
  std::vector<std::string> texts;
  for (const NamedMotion& motion : motions_of(scenario)) {
    std::string text = aliasing_of(motion, scenario);
    if (!text.empty()) texts.push_back(std::move(text));
  }
  return texts;
}

void RunWarnings::add(const Recording& block) {
  samples_ += block.status.size();
  for (const std::uint8_t status : block.status) {
    powered_ += (status & kUnpowered) == 0;
    saturated_ += (status & kOutputSaturated) != 0;
    unlocked_ += (status & kLoopNotLocked) != 0;
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Column* column = find_column(
        block, fmt::format("true_{}_temperature", kThermalNodeNames[i]));
    if (column == nullptr) continue;
    Node& node = nodes_[i];
    for (const double value : column->values) {
      if (value >= kMaterialTemperatures.low &&
          value <= kMaterialTemperatures.high)
        continue;
      ++node.outside;
      node.lowest = std::min(node.outside == 1 ? value : node.lowest, value);
      node.highest = std::max(node.outside == 1 ? value : node.highest, value);
    }
  }
}

std::string RunWarnings::heat_text() const {
  std::string nodes;
  std::size_t worst = 0;
  double farthest = 0, reached = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].outside == 0) continue;
    nodes +=
        fmt::format("{}{}", nodes.empty() ? "" : ", ", kThermalNodeNames[i]);
    worst = std::max(worst, nodes_[i].outside);
    for (const double value : {nodes_[i].lowest, nodes_[i].highest}) {
      const double excess = std::max(value - kMaterialTemperatures.high,
                                     kMaterialTemperatures.low - value);
      if (excess > farthest) {
        farthest = excess;
        reached = value;
      }
    }
  }
  if (nodes.empty()) return {};
  return fmt::format(
      "{} at up to {:.4g} degC in {} samples, beyond {:g} to {:g} degC, {}; "
      "likely cause: thermal.electronics_power_W = {:g}",
      nodes, reached, share(worst, samples_), kMaterialTemperatures.low,
      kMaterialTemperatures.high, kMaterialReason,
      device_.thermal.electronics_power);
}

std::string RunWarnings::power_text() const {
  if (powered_ > 0) return {};
  return fmt::format(
      "all {} samples are unpowered: power.on_s = {:g} is not before "
      "duration_s = {:g}",
      samples_, scenario_.powered.front().on, scenario_.duration);
}

std::string RunWarnings::saturation_text() const {
  if (powered_ == 0 || 2 * saturated_ < powered_) return {};
  return fmt::format(
      "{} powered samples are saturated; likely cause: rates and drift beyond "
      "readout.full_scale_deg_per_s = {:g}",
      share(saturated_, powered_), device_.readout.full_scale / kDegree);
}

std::string RunWarnings::lock_text() const {
  if (powered_ == 0 || 2 * unlocked_ < powered_) return {};
  const std::string cause =
      scenario_.fidelity == Fidelity::kQuasistatic
          ? fmt::format(
                "the drive needs more than drive.voltage_limit_V = {:g}",
                device_.drive.voltage_limit)
          : fmt::format(
                "the loops lock within {:g} s of a power-on, and the "
                "run has little more",
                kLockTime);
  return fmt::format(
      "in {} powered samples the loops are not locked; likely "
      "cause: {}",
      share(unlocked_, powered_), cause);
}

std::vector<std::string> RunWarnings::texts() const {
  std::vector<std::string> texts = aliasing_warnings(scenario_);
  for (std::string text : {soaks_text(scenario_), heat_text(), power_text(),
                           saturation_text(), lock_text()})
    if (!text.empty()) texts.push_back(std::move(text));
  return texts;
}

}  // namespace beamgyro
