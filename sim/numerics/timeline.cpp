// SPDX-License-Identifier: MIT
#include "sim/numerics/timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamgyro::internal {

bool is_same_time(double a, double b) {
  constexpr double kShortest = 1e-9;  // [s]
  constexpr double kRelative = 64 * std::numeric_limits<double>::epsilon();
  return std::abs(a - b) <=
         std::max(kShortest, kRelative * std::min(std::abs(a), std::abs(b)));
}

std::vector<Piece> pieces_until(double end, std::vector<Border> borders) {
  borders.insert(borders.end(), {{0}, {end}});
  std::erase_if(borders,
                [&](const Border& b) { return b.time < 0 || b.time > end; });
  std::sort(borders.begin(), borders.end(),
            [](const Border& a, const Border& b) { return a.time < b.time; });
  std::vector<Piece> pieces;
  Border last = borders.front();
  for (const Border& border : borders) {
    if (is_same_time(border.time, last.time)) {
      last = {border.time, border.jump || last.jump};
    } else {
      pieces.push_back({last.time, border.time, last.jump});
      last = border;
    }
  }
  return pieces;
}

std::vector<double> SampleGrid::times(std::size_t first, std::size_t n) const {
  std::vector<double> times(n);
  for (std::size_t i = 0; i < n; ++i) times[i] = time(first + i);
  return times;
}

std::size_t SampleGrid::first_from(double t) const {
  if (!(t > 0)) return 0;
  std::size_t k = t * rate < static_cast<double>(count)
                      ? static_cast<std::size_t>(t * rate)
                      : count;
  // The product may be a rounding beside the sample.
  while (k < count && time(k) < t) ++k;
  while (k > 0 && time(k - 1) >= t) --k;
  return k;
}

}  // namespace beamgyro::internal
