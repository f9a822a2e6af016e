// SPDX-License-Identifier: MIT
#include "compensation/methods/soak_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "compensation/methods/population.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr int kRounds = 8;     // each halves the fastest rate of a stretch
constexpr double kSlow = 1.5;  // over steady_K_per_min, of a row to the next
constexpr double kMostMissing = 10.0;  // rows between two that follow
// [K], by which a lag that is corrected with a noisy rate moves a row. Soaks
// that a faster ramp leads to are farther apart.
constexpr double kJump = 0.5 * kPointWidth;
constexpr Index kReach = 3;    // rows: noise of the temperature averages out
constexpr double kFast = 0.9;  // quantile of the rates of a stretch

// Stretches of rows between which the temperature changes slowly, also where
// rows are left out.
std::vector<RowStretch> following_rows(const TrainingRows& rows,
                                       double steady_K_per_min) {
  const double fastest = kSlow * steady_K_per_min / 60.0;  // [K/s]
  double spacing = HUGE_VAL;
  for (Index k = 1; k < rows.size(); ++k)
    if (rows.time(k) > rows.time(k - 1))
      spacing = std::min(spacing, rows.time(k) - rows.time(k - 1));
  std::vector<RowStretch> stretches;
  for (Index k = 0; k < rows.size(); ++k) {
    const bool anew =
        k == 0 || rows.time(k) - rows.time(k - 1) > kMostMissing * spacing ||
        rows.cycle(k) != rows.cycle(k - 1) || rows.run(k) != rows.run(k - 1) ||
        std::abs(rows.temperature(k) - rows.temperature(k - 1)) >
            kJump + fastest * (rows.time(k) - rows.time(k - 1));
    if (anew) stretches.push_back({k, k});
    stretches.back().end = k + 1;
  }
  return stretches;
}

// |dT/dt| of each row of a stretch, from rows before and after it [K/s].
std::vector<double> rates(const TrainingRows& rows, const RowStretch& of) {
  std::vector<double> found;
  for (Index k = of.begin; k < of.end; ++k) {
    const Index before = std::max(k - kReach, of.begin);
    const Index after = std::min(k + kReach, of.end - 1);
    found.push_back(
        std::abs(rows.temperature(after) - rows.temperature(before)) /
        (rows.time(after) - rows.time(before)));
  }
  return found;
}

double fast_rate(std::vector<double> rates) {
  const auto fast =
      rates.begin() +
      static_cast<std::ptrdiff_t>(kFast * static_cast<double>(rates.size()));
  std::ranges::nth_element(rates, fast);
  return *fast;
}

bool holds_a_ramp(const TrainingRows& rows, const RowStretch& of) {
  const auto T = rows.temperature.segment(of.begin, of.end - of.begin);
  return of.end - of.begin > 2 && T.maxCoeff() - T.minCoeff() > kPointWidth;
}

}  // namespace

TrainingRows rows_of_soaks(const TrainingRows& all, double steady_K_per_min) {
  TrainingRows rows = all;
  for (int round = 0; round < kRounds; ++round) {
    RowMask keep = RowMask::Constant(rows.size(), true);
    for (const RowStretch& stretch : following_rows(rows, steady_K_per_min)) {
      if (!holds_a_ramp(rows, stretch)) continue;
      const std::vector<double> own = rates(rows, stretch);
      const double limit = fast_rate(own) / 2.0;
      for (std::size_t k = 0; k < own.size(); ++k)
        keep(stretch.begin + static_cast<Index>(k)) = own[k] < limit;
    }
    if (keep.all() || !keep.any()) return rows;
    rows = selected(rows, keep);
  }
  return rows;
}

}  // namespace beamgyro::internal
