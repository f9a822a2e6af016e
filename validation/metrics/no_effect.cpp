// SPDX-License-Identifier: MIT
#include "validation/metrics/no_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/residual_scores.h"

namespace beamgyro::internal {
namespace {

constexpr double kNothing = 1e-4;       // [deg/s]
constexpr double kShareOfError = 0.01;  // [-]

}  // namespace

double temperature_span(const Evidence& evidence) {
  std::vector<const Recording*> all;
  for (const EvidenceRun& run : evidence.runs) all.push_back(run.recording);
  const auto range = temperatures_of(all);
  return range ? range->highest - range->lowest : 0.0;
}

std::string words_of_no_effect(const Evidence& before, const Evidence& after) {
  if (temperature_span(before) < kLeastSpanOfRuns) return "";
  std::vector<double> errors, corrections;
  for (std::size_t k = 0; k < before.runs.size(); ++k) {
    const Recording& run = *before.runs[k].recording;
    const auto blocks = score_blocks(run);
    const auto add = [&](const std::vector<double>& other,
                         std::vector<double>& all) {
      const auto means = block_residuals(blocks, before.runs[k].rate, other);
      all.insert(all.end(), means.begin(), means.end());
    };
    add(column_values(run, "true_rate"), errors);
    add(after.runs[k].rate, corrections);
  }
  if (errors.size() < 2) return "";
  const ResidualScores error = residual_scores(errors);
  const ResidualScores change = residual_scores(corrections);
  const double nothing = std::min(kNothing, kShareOfError * error.sigma);
  // Nor for a change that is not finite.
  if (!(change.sigma <= nothing)) return "";
  if (std::abs(change.mean) <= nothing)
    return "The compensator does nothing: its answers are the recorded rate.";
  return fmt::format(
      "The compensator takes away one constant, {:.4g} deg/s, and nothing that "
      "changes with the temperature.",
      change.mean);
}

}  // namespace beamgyro::internal
