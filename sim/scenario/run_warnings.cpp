// SPDX-License-Identifier: MIT
#include "sim/scenario/run_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units.h"
#include "sim/scenario/aliasing.h"
#include "sim/scenario/drive_lock.h"
#include "sim/thermal/material_range.h"

namespace beamgyro::internal {
namespace {

std::string soaks_text(const ScenarioPlan& scenario) {
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
std::string power_cause(const ScenarioPlan& scenario) {
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

bool is_beyond_ceramic(double celsius) {
  constexpr double kThermalError = 1e-3;  // [K], of a run
  return celsius < kLinearCeramic.low - kThermalError ||
         celsius > kLinearCeramic.high + kThermalError;
}

std::string share(std::size_t count, std::size_t all) {
  return count == all ? fmt::format("all {}", all)
                      : fmt::format("{} of {}", count, all);
}

}  // namespace

void RunWarnings::Temperatures::add(double celsius) {
  lowest = count == 0 ? celsius : std::min(lowest, celsius);
  highest = count == 0 ? celsius : std::max(highest, celsius);
  ++count;
}

void RunWarnings::add(const Recording& block) {
  const std::vector<double>& beam =
      column_values(block, "true_beam_temperature");
  const std::vector<double>& voltage = column_values(block, "drive_voltage");
  const double limit =
      device_.drive.voltage_limit - device_.readout.drive_voltage_resolution;
  samples_ += block.status.size();
  for (std::size_t k = 0; k < block.status.size(); ++k) {
    const std::uint8_t status = block.status[k];
    powered_ += (status & kUnpowered) == 0;
    saturated_ += (status & kOutputSaturated) != 0;
    if (is_beyond_ceramic(beam[k])) clamped_.add(beam[k]);
    if ((status & kLoopNotLocked) == 0) continue;
    ++unlocked_;
    limited_ += std::abs(voltage[k]) >= limit;
    if (lock_is_due(scenario_, block.time[k])) lost_.add(beam[k]);
  }
}

std::string RunWarnings::heat_text() const {
  if (clamped_.count == 0) return {};
  return fmt::format(
      "the beam is at {:.4g} to {:.4g} degC in {} samples, beyond {:g} to {:g} "
      "degC, where the ceramic's coefficients are linear; they keep the values "
      "of the nearest end",
      clamped_.lowest, clamped_.highest, share(clamped_.count, samples_),
      kLinearCeramic.low, kLinearCeramic.high);
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
  const bool is_lost = lost_.count > 0;
  if (!is_lost && (powered_ == 0 || 2 * unlocked_ < powered_)) return {};
  std::string text = fmt::format(
      "in {} powered samples the loops are not locked; likely cause: ",
      share(unlocked_, powered_));
  if (2 * limited_ >= unlocked_) {
    text +=
        fmt::format("the drive needs more than drive.voltage_limit_V = {:g}",
                    device_.drive.voltage_limit);
  } else if (is_lost) {
    text += "the drive loop does not hold amplitude and phase of this device";
  } else {
    text += fmt::format(
        "the loops lock within {:g} s of a power-on, and the run has little "
        "more",
        kLockTime);
  }
  if (!is_lost) return text;
  return text + fmt::format(" with the beam at {:.4g} to {:.4g} degC",
                            lost_.lowest, lost_.highest);
}

std::vector<std::string> RunWarnings::texts() const {
  std::vector<std::string> texts = aliasing_warnings(scenario_);
  for (std::string text : {soaks_text(scenario_), heat_text(), power_text(),
                           saturation_text(), lock_text()})
    if (!text.empty()) texts.push_back(std::move(text));
  return texts;
}

}  // namespace beamgyro::internal
