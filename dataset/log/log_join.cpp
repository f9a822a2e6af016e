// SPDX-License-Identifier: MIT
#include "dataset/log/log_join.h"

#include <utility>

namespace beamgyro {

JoinedRows::JoinedRows(Recording recording, double longest_gap)
    : recording_(std::move(recording)), longest_gap_(longest_gap) {}

bool JoinedRows::read(double time, std::vector<double>& values) {
  const std::vector<double>& times = recording_.time;
  while (next_ < times.size() && times[next_] < time) ++next_;
  if (next_ == times.size()) return false;
  const std::size_t k = next_;
  const bool is_at_sample = times[k] == time;
  if (!is_at_sample && (k == 0 || times[k] - times[k - 1] > longest_gap_))
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

}  // namespace beamgyro
