// SPDX-License-Identifier: MIT
#include "compensation/scoring/replayed_scale_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/inputs/sample_ranges.h"

namespace beamgyro::internal {
namespace {

bool is_near(double a, double b) { return std::abs(a - b) <= kRateReach; }

bool is_covered(const RecordedRates& rates, double temperature) {
  return std::ranges::any_of(rates.plateaus,
                             [&](const PlateauSlope& plateau) {
                               return is_near(plateau.temperature, temperature);
                             }) &&
         std::ranges::any_of(rates.large, [&](double large) {
           return is_near(large, temperature);
         });
}

bool is_borne_out(const RecordedRates& rates, double temperature, double s) {
  return std::ranges::any_of(rates.plateaus, [&](const PlateauSlope& plateau) {
    return is_near(plateau.temperature, temperature) &&
           std::abs(plateau.raw / plateau.truth / s - 1.0) <= kTableSupport;
  });
}

/// Returns the inputs that a rate may move in the gyro and does not move in a
/// replay. The temperature does not depend on the rate.
std::vector<std::string> inputs_without_rate(const std::vector<Input>& inputs) {
  std::vector<std::string> names;
  for (const Input& input : inputs)
    if (!sees_the_rate(input) && !input.column.empty() &&
        input.column != "temperature" &&
        std::ranges::find(names, input.column) == names.end())
      names.push_back(input.column);
  return names;
}

void note_untested(const std::string& name, double temperature,
                   ReplayedScaleFactor& found) {
  if (std::ranges::find(found.untested, name) != found.untested.end()) return;
  if (found.untested.empty()) found.untested_temperature = temperature;
  found.untested.push_back(name);
}

/// Removes the wanted correction of the scale factor from a block. Returns
/// nothing when the table changes the scale factor and no recorded rate tests
/// the table.
class BlockJudge {
 public:
  BlockJudge(const Compensator& compensator, const RecordedRates& rates,
             const ScaleFactorTolerance& tolerance)
      : compensator_(compensator), rates_(rates), tolerance_(tolerance) {}

  std::optional<ReplayedBlock> judged(const ReplayedBlock& block,
                                      ReplayedScaleFactor& found) const {
    if (!compensator_.scale_factor) return block;
    const TemperatureRange& range = compensator_.temperature_range;
    const double s = compensator_.scale_factor->at(
        std::clamp(block.temperature, range.lowest, range.highest));
    ReplayedBlock corrected = block;
    corrected.retained *= s;
    if (is_borne_out(rates_, block.temperature, s)) return corrected;
    if (std::abs(1.0 / s - 1.0) <= tolerance_.every_rate) return block;
    note_untested("scale_factor", block.temperature, found);
    const bool only_table =
        std::abs(corrected.retained - 1.0) <= tolerance_.at(block.rate);
    const bool plausible = block.retained >= kCancelledBelow &&
                           block.retained <= 1.0 / kCancelledBelow;
    return only_table && plausible ? std::nullopt : std::optional(block);
  }

 private:
  const Compensator& compensator_;
  const RecordedRates& rates_;
  const ScaleFactorTolerance& tolerance_;
};

std::optional<double> worst_plateau(const RecordedRates& rates) {
  std::optional<double> worst;
  for (const PlateauSlope& plateau : rates.plateaus) {
    const double retained = plateau.compensated / plateau.raw;
    if (!worst || is_worse({0.0, 0.0, 0.0, retained}, {0.0, 0.0, 0.0, *worst}))
      worst = retained;
  }
  return worst;
}

}  // namespace

bool needs_recorded_rates(const Compensator& compensator) {
  return compensator.scale_factor.has_value() ||
         !inputs_without_rate(compensator.inputs).empty();
}

void add_recorded_rates(const Recording& recording,
                        std::span<const double> compensated, double full_scale,
                        RecordedRates& rates) {
  for (const PlateauSlope& plateau :
       plateau_slopes(recording, kTableRate, compensated))
    rates.plateaus.push_back(plateau);
  const Column* temperature = find_column(recording, "temperature");
  if (temperature == nullptr) return;
  const auto& truth = column_values(recording, "true_rate");
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const SampleRange& stretch : powered_stretches(recording))
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const double here = std::round(temperature->values[k]);
      if (std::abs(truth[k]) < kLargeShare * full_scale || here == last)
        continue;
      last = here;
      if (std::ranges::find(rates.large, here) == rates.large.end())
        rates.large.push_back(here);
    }
}

void ReplayedScaleFactor::add(const ReplayedScaleFactor& other) {
  full_scale = std::max(full_scale, other.full_scale);
  temperatures.lowest =
      std::min(temperatures.lowest, other.temperatures.lowest);
  temperatures.highest =
      std::max(temperatures.highest, other.temperatures.highest);
  worst.add(other.worst);
  fixed_inputs = other.fixed_inputs;
  for (const std::string& name : other.untested)
    note_untested(name, other.untested_temperature, *this);
  worst_plateau = other.worst_plateau;
  over_temperature.add(other.over_temperature);
}

std::optional<ReplayedScaleFactor> replayed_scale_factor(
    const Compensator& compensator, const Recording& recording,
    std::span<const double> answers, double full_scale,
    const ScaleFactorTolerance& tolerance, const RecordedRates& rates) {
  const auto blocks = replay(
      [&compensator](const Recording& any) {
        return compensated_rate(compensator, any);
      },
      recording, answers, full_scale);
  if (!blocks) return std::nullopt;
  ReplayedScaleFactor found{
      .full_scale = full_scale,
      .fixed_inputs = inputs_without_rate(compensator.inputs)};
  if (!found.fixed_inputs.empty()) {
    found.worst_plateau = worst_plateau(rates);
    const auto uncovered =
        std::ranges::find_if(*blocks, [&rates](const ReplayedBlock& block) {
          return !is_covered(rates, block.temperature);
        });
    if (uncovered != blocks->end())
      for (const std::string& name : found.fixed_inputs)
        note_untested(name, uncovered->temperature, found);
  }
  const BlockJudge judge(compensator, rates, tolerance);
  for (const ReplayedBlock& block : *blocks) {
    found.temperatures.lowest =
        std::min(found.temperatures.lowest, block.temperature);
    found.temperatures.highest =
        std::max(found.temperatures.highest, block.temperature);
    const auto judged = judge.judged(block, found);
    if (judged) found.worst.add(*judged);
  }
  return found;
}

}  // namespace beamgyro::internal
