// SPDX-License-Identifier: MIT
#include "sim/scenario/run_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units.h"
#include "sim/scenario/aliasing.h"
#include "sim/scenario/drive_lock.h"
#include "sim/thermal/material_range.h"

namespace beamgyro {
namespace {

std::string soaks_text(const Scenario& scenario) {
  constexpr double kRoundoff = 1e-9;  // as for the number of samples
  const std::vector<double>& ends = scenario.soak_ends;
  const auto cut = std::ranges::count_if(ends, [&](double end) {
    return end > scenario.duration * (1 + kRoundoff);
  });
  if (cut == 0) return {};
  return fmt::format(
      "ambient.soaks: duration_s = {:.11g} cuts {} of {} soaks; the last ends "
      "at {:.11g} s",
      scenario.duration, cut, ends.size(), ends.back());
}

/// Why no sample is powered.
std::string power_cause(const Scenario& scenario) {
  const SampleGrid grid = sample_grid(scenario);
  const double last = grid.time(grid.count - 1);
  std::string before, after;
  for (const PowerInterval& powered : scenario.powered) {
    if (powered.on <= last) {
      before = powered.off <= 0
                   ? fmt::format("the power is off since power.off_s = {}",
                                 powered.off)
                   : fmt::format(
                         "the power is on at power.on_s = {} and off again at "
                         "power.off_s = {}, between samples {:g} s apart",
                         powered.on, powered.off, 1 / grid.rate);
      continue;
    }
    after =
        powered.on < scenario.duration
            ? fmt::format("power.on_s = {} is after the last sample, at {:g} s",
                          powered.on, last)
            : fmt::format("power.on_s = {} is not before duration_s = {}",
                          powered.on, scenario.duration);
    break;
  }
  return before + (before.empty() || after.empty() ? "" : ", and ") + after;
}

std::string share(std::size_t count, std::size_t all) {
  return count == all ? fmt::format("all {}", all)
                      : fmt::format("{} of {}", count, all);
}

}  // namespace

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
  return fmt::format("all {} samples are unpowered: {}", samples_,
                     power_cause(scenario_));
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
