// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>

#include "include/beamgyro/verdict.h"
#include "validation/metrics/metric.h"

namespace beamgyro::internal {

/// What a metric may be, in its unit.
struct Limit {
  std::string metric;                // a name of metrics(), or of an own one
  std::optional<double> least = {};  // smallest value allowed
  std::optional<double> most = {};   // largest value allowed
  bool absolute = false;             // of the value without its sign
  // Empty, or "before" (the recorded rate), "constant", "cubic", "spline" or
  // "straight_lines" (a baseline): the limit is then of |metric| divided by
  // |metric| of that one.
  std::string relative_to = {};
  std::string source = {};  // where the number comes from
  std::string place = {};   // file:line:column
  bool is_own = false;      // of a metric of the user's own

  /// Returns whether the limits contain a value [unit of the metric].
  bool contains(double value) const;
};

/// Returns the limit in words: "at most 0.1", "0.98 to 1.02".
std::string text_of(const Limit& limit);

/// Returns kFail if one of them fails, else kUndecided if one of them is
/// undecided, else kPass. Of none it is kPass.
Verdict worst_of(std::span<const Verdict> all);

/// Whether a verdict is worse than another one.
bool is_more_severe(Verdict one, Verdict other);

/// The largest probability with which a device beyond a limit passes, for a
/// guard band of the whole 95 % interval.
constexpr double kFalseAcceptRisk = 0.025;  // [-]

/// A limit, what was found, and what follows.
struct Decision {
  Verdict result = Verdict::kUndecided;
  // What was compared with the limit: the value itself, without its sign, or
  // divided by that of another rate.
  std::optional<Estimate> compared = {};
  // From the value to the nearer limit, positive within; in the unit of the
  // limit. Nothing without a value.
  std::optional<double> margin = {};
  double guard_band = 0.0;  // at that limit, same unit
  bool met_before = false;  // the recorded rate meets the limit, too
  // Undecided, and the interval is wider than what the limit leaves above 0, so
  // that hardly any value would be decided.
  bool too_noisy = false;
  std::string words;  // one sentence for a user
};

/// Decides on a limit. `after` is the metric of the compensated rate,
/// `reference` that of the rate that limit.relative_to names. With z(p) the
/// normal quantile the guard band is the part of the 95 % interval towards the
/// limit, times w = z(1 - risk) / z(0.975). For w above 1 it is that part and
/// w - 1 times the larger of the two, since a figure that noise enlarges has an
/// interval that reaches little or nothing above it.
/// - A value without an interval is decided without a guard band, and so is
///   every value where the risk is 0.5 and w is 0.
/// - No value, or one that is not finite, is undecided.
/// - A quotient has an interval whose ends lie, in logarithms, as far from it
///   as the root of the sum of squares of those of its two parts.
/// Throws std::invalid_argument for a risk outside (0, 0.5].
Decision decide(const Limit& limit, const std::optional<Estimate>& after,
                const std::optional<Estimate>& reference = {},
                double risk = kFalseAcceptRisk);

}  // namespace beamgyro::internal
