// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "validation/evidence/evidence.h"
#include "validation/specification/decision.h"

namespace beamgyro::internal {

/// The rate of the runs that a metric is evaluated on.
enum class JudgedRate { kRecorded, kCompensated };

/// A metric of the user's own: a function, or figures of a table.
struct OwnMetricSource {
  std::string name, unit;
  // Returns its value; NaN: none. `evidence` has the rate that is judged.
  std::function<double(const Evidence& evidence, JudgedRate rate)> value;
};

/// The value of a metric of the user's own, without an interval. It may be NaN
/// or infinite.
struct OwnMetricResult {
  std::string name, unit;
  Estimate before, after;
};

/// Metrics of a table, in its order, and the limits that it sets.
struct OwnMetricTable {
  std::vector<OwnMetricSource> metrics;
  std::vector<Limit> limits;
};

/// Reads comma-separated rows below the names `name,unit,before,after`, with or
/// without `low,high`, the smallest and the largest value that is allowed. An
/// empty cell of a number is none. Throws std::invalid_argument
/// "file:line:column: ..." for anything else, a name that require_own_name()
/// refuses or that stands there twice, and `low` above `high`.
OwnMetricTable parse_own_metrics(std::string_view text,
                                 const std::filesystem::path& path);

/// Throws std::invalid_argument, which begins with `place`, unless a name has
/// letters, digits and _ only, begins with a letter, has at most 64 characters,
/// and is none of a metric or check of the program; and for a unit that is not
/// 1 to 32 printable characters of ASCII.
void require_own_name(const std::string& place, const std::string& name,
                      const std::string& unit);

/// Throws std::invalid_argument with its place for a limit on a metric of the
/// user's own that there is not.
void require_own_metrics(std::span<const Limit> limits,
                         std::span<const OwnMetricSource> metrics);

/// Evaluates metrics of the user's own, one after the other.
std::vector<OwnMetricResult> own_metric_results(
    std::span<const OwnMetricSource> metrics, const Evidence& before,
    const Evidence& after);

}  // namespace beamgyro::internal
