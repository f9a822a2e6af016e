// SPDX-License-Identifier: MIT
#include "planning/chamber_time.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {

std::vector<double> in_visiting_order(std::vector<double> temperatures,
                                      double start) {
  std::ranges::sort(temperatures);
  if (!temperatures.empty() && std::abs(temperatures.back() - start) <
                                   std::abs(temperatures.front() - start))
    std::ranges::reverse(temperatures);
  return temperatures;
}

double shortest_way(const std::vector<double>& temperatures, double start) {
  if (temperatures.empty()) return 0.0;
  const auto [low, high] = std::ranges::minmax(temperatures);
  return high - low + std::min(std::abs(start - low), std::abs(start - high));
}

double chamber_hours(const std::vector<double>& temperatures,
                     const ChamberTime& time) {
  return shortest_way(temperatures, time.start) / time.ramp / 60.0 +
         static_cast<double>(temperatures.size()) * time.hold / 3600.0;
}

std::vector<Visit> visits(const std::vector<double>& temperatures,
                          const ChamberTime& time) {
  std::vector<Visit> found;
  double clock = 0.0, before = time.start;
  for (const double T : in_visiting_order(temperatures, time.start)) {
    clock += std::abs(T - before) / time.ramp * 60.0;
    found.push_back({T, clock, clock + time.hold});
    clock += time.hold;
    before = T;
  }
  return found;
}

}  // namespace beamgyro::internal
