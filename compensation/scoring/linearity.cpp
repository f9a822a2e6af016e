// SPDX-License-Identifier: MIT
#include "compensation/scoring/linearity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/scale_factor.h"

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
    if (sign * held.rate >= 0.0) {
      side.push_back(held);
    }
  }
  return fit(side).slope;
}

std::vector<HeldRate> held_rates(const Recording& recording,
                                 const std::vector<double>& truth,
                                 std::span<const double> rate,
                                 const SampleRange& plateau, double settling) {
  struct Sum {
    double answer = 0.0;  // [deg/s]
    double samples = 0.0;
  };
  std::map<double, Sum> sums;
  double set_at = recording.time[plateau.begin];  // [s]
  for (std::size_t k = plateau.begin; k < plateau.end; ++k) {
    if (k > plateau.begin && truth[k] != truth[k - 1]) {
      set_at = recording.time[k];
    }
    const bool saturated = (recording.status[k] & kOutputSaturated) != 0;
    if (!saturated && recording.time[k] - set_at >= settling) {
      Sum& sum = sums[truth[k]];
      sum.answer += rate[k];
      sum.samples += 1.0;
    }
  }
  std::vector<HeldRate> table;
  for (const auto& [held, sum] : sums) {
    table.push_back({held, sum.answer / sum.samples});
  }
  return table;
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
  double deviation = 0.0;
  double full_scale = 0.0;
  for (const HeldRate& held : table) {
    const double answer = line.offset + line.slope * held.rate;
    deviation = std::max(deviation, std::abs(held.answer - answer));
    full_scale = std::max(full_scale, std::abs(held.rate));
  }
  const double positive = slope_of_side(table, 1.0);
  const double negative = slope_of_side(table, -1.0);
  return {
      .nonlinearity = 1e6 * deviation / (std::abs(line.slope) * full_scale),
      .asymmetry = 1e6 * 2.0 * (positive - negative) / (positive + negative),
      .rates = table.size(),
      .slope = line.slope};
}

std::optional<Linearity> linearity(const Recording& recording,
                                   std::span<const double> rate) {
  const auto& truth = column_values(recording, "true_rate");
  if (rate.size() != recording.time.size()) {
    throw std::invalid_argument(
        fmt::format("rate: {} values for {} times, must be one each",
                    rate.size(), recording.time.size()));
  }
  const double settling = kSettlingTime - 0.5 * usual_step(recording);
  std::optional<Linearity> worst;
  for (const SampleRange& plateau : temperature_plateaus(recording)) {
    const auto table = held_rates(recording, truth, rate, plateau, settling);
    if (!is_rate_table(table)) {
      continue;
    }
    const Linearity found = linearity_of(table);
    if (!worst || std::isnan(found.nonlinearity) ||
        found.nonlinearity > worst->nonlinearity) {
      worst = found;
    }
  }
  return worst;
}

}  // namespace beamgyro::internal
