// SPDX-License-Identifier: MIT
#include "compensation/scoring/linearity.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace beamgyro::internal {
namespace {

struct Line {
  double offset = 0.0;  // [deg/s]
  double slope = 0.0;   // [-]
};

Line fit(std::span<const HeldRate> table) {
  double rate = 0.0;
  double answer = 0.0;
  for (const HeldRate& held : table) {
    rate += held.rate;
    answer += held.answer;
  }
  rate /= static_cast<double>(table.size());
  answer /= static_cast<double>(table.size());
  double variance = 0.0;
  double covariance = 0.0;
  for (const HeldRate& held : table) {
    variance += (held.rate - rate) * (held.rate - rate);
    covariance += (held.rate - rate) * (held.answer - answer);
  }
  const double slope = covariance / variance;
  return {answer - slope * rate, slope};
}

double slope_of_side(std::span<const HeldRate> table, double sign) {
  std::vector<HeldRate> side;
  for (const HeldRate& held : table) {
    if (sign * held.rate >= 0.0) side.push_back(held);
  }
  return fit(side).slope;
}

}  // namespace

bool is_rate_table(std::span<const HeldRate> table) {
  const auto positive = std::ranges::count_if(
      table, [](const HeldRate& held) { return held.rate > 0.0; });
  const auto negative = std::ranges::count_if(
      table, [](const HeldRate& held) { return held.rate < 0.0; });
  return table.size() >= kLeastRatesOfTable && positive >= 2 && negative >= 2;
}

Linearity linearity_of(std::span<const HeldRate> table) {
  const Line line = fit(table);
  double full_scale = 0.0;
  for (const HeldRate& held : table)
    full_scale = std::max(full_scale, std::abs(held.rate));
  Linearity found{.departures = {}, .rates = table.size(), .slope = line.slope};
  for (const HeldRate& held : table) {
    const double answer = line.offset + line.slope * held.rate;
    found.departures.push_back(1e6 * (held.answer - answer) /
                               (line.slope * full_scale));
    found.nonlinearity =
        std::max(found.nonlinearity, std::abs(found.departures.back()));
  }
  const double positive = slope_of_side(table, 1.0);
  const double negative = slope_of_side(table, -1.0);
  found.asymmetry = 1e6 * 2.0 * (positive - negative) / (positive + negative);
  return found;
}

}  // namespace beamgyro::internal
