// SPDX-License-Identifier: MIT
#include "dataset/log/log_join.h"

#include <utility>

#include "dataset/log/log_statistics.h"

namespace beamgyro::internal {

JoinedRows::JoinedRows(Recording recording, double longest_gap, double rounding)
    : recording_(std::move(recording)),
      longest_gap_(longest_gap),
      rounding_(rounding) {}

bool JoinedRows::read(double time, double rounding,
                      std::vector<double>& values) {
  const std::vector<double>& times = recording_.time;
  const double same = rounding + rounding_;
  while (next_ < times.size() && time - times[next_] > same) ++next_;
  if (next_ == times.size()) return false;
  const std::size_t k = next_;
  const bool is_at_sample = times[k] - time <= same;
  if (!is_at_sample &&
      (k == 0 || times[k] - times[k - 1] > longest_gap_ + 2 * rounding_))
    return false;
  for (std::size_t i = 0; i < recording_.columns.size(); ++i) {
    const std::vector<double>& x = recording_.columns[i].values;
    values[i] = is_at_sample ? x[k]
                             : x[k - 1] + (x[k] - x[k - 1]) *
                                              ((time - times[k - 1]) /
                                               (times[k] - times[k - 1]));
  }
  return true;
}

double JoinedRows::period() const { return median_step(recording_.time); }

}  // namespace beamgyro::internal
