// SPDX-License-Identifier: MIT
#include "cli/time_left.h"

#include <fmt/format.h>

#include <cmath>

namespace beamgyro::internal {

void TimeLeft::note(double elapsed, double share) {
  samples_.push_back({elapsed, share});
  while (samples_.size() > 2 && samples_[1].elapsed <= elapsed / 2)
    samples_.pop_front();
}

std::optional<double> TimeLeft::seconds() const {
  const Sample &first = samples_.front(), &last = samples_.back();
  const double done = last.share - first.share;
  if (!(done > 0)) return {};
  return (1 - last.share) * (last.elapsed - first.elapsed) / done;
}

std::string clock_text(double seconds) {
  const auto whole = static_cast<long>(std::floor(seconds));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60,
                     whole % 60);
}

}  // namespace beamgyro::internal
