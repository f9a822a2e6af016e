// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "statistics/intervals.h"
#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// The value of a metric, with its 95 % interval where the metric has one.
struct Estimate {
  double value;
  std::optional<Interval> interval = {};
};

/// Evaluates a metric. Returns nothing when no run shows it. Thread-safe.
using Evaluation =
    std::function<std::optional<Estimate>(const Evidence& evidence)>;

/// A metric of the validator: what it is called, what it means and how it is
/// evaluated.
struct Metric {
  std::string_view name;          // as in specifications and JSON
  std::string_view title;         // in words without the unit, for a heading
  std::string_view unit;          // deg/s, s, ppm, ...
  std::string_view clause;        // of IEEE 1431, or empty
  std::string_view definition;    // one sentence with its formula
  std::vector<RunPurpose> reads;  // the purposes of runs it is evaluated on
  Evaluation evaluate;
  // That of a perfect compensator, in the unit; infinite: the more the better.
  double best = 0.0;
  // Results have it only where the compensator states a sigma.
  bool is_of_sigma = false;
};

/// Returns how far a value is from the best one, in the unit of the metric; the
/// smaller, the better. Where the best is infinite, it is the value with the
/// other sign.
double shortfall_of(const Metric& metric, double value);

/// Returns every metric, in the order of reports.
std::span<const Metric> metrics();

/// Returns the metric of that name, or nullptr.
const Metric* find_metric(std::string_view name);

}  // namespace beamgyro::internal
