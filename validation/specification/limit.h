// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace beamgyro::internal {

/// What a metric may be, in its unit.
struct Limit {
  std::string metric;                // a name of metrics()
  std::optional<double> least = {};  // smallest value allowed
  std::optional<double> most = {};   // largest value allowed
  bool absolute = false;             // of the value without its sign
  // Empty, or "before" (the recorded rate), "constant", "cubic" or "spline" (a
  // baseline): the limit is then of |metric| divided by |metric| of that one.
  std::string relative_to = {};
  std::string source = {};  // where the number comes from
  std::string place = {};   // file:line:column

  /// Returns whether the limits contain a value [unit of the metric].
  bool contains(double value) const;
};

/// Returns the limit in words: "at most 0.1", "0.98 to 1.02".
std::string text_of(const Limit& limit);

}  // namespace beamgyro::internal
