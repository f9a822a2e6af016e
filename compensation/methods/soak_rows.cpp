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
// Of a soak that settles: the rate of its last rows over that of its first, at
// most, and the temperatures that it spans [K].
constexpr double kSettling = 0.75;
constexpr double kSettlingSpan = 2.0 * kPointWidth;

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

double rate_quantile(std::vector<double> own, double share) {
  const auto at = own.begin() + static_cast<std::ptrdiff_t>(
                                    share * static_cast<double>(own.size()));
  std::ranges::nth_element(own, at);
  return *at;
}

double stretch_span(const TrainingRows& rows, const RowStretch& of) {
  const auto T = rows.temperature.segment(of.begin, of.end - of.begin);
  return T.maxCoeff() - T.minCoeff();
}

// The rate that rows of a stretch with a ramp stay below. Of a soak after a
// ramp that is left out, whose lag is corrected while it settles, no row may be
// slow: the slower half stays.
double slow_rate(const TrainingRows& rows, const RowStretch& of,
                 const std::vector<double>& own) {
  const double limit = rate_quantile(own, kFast) / 2.0;
  const bool settles = std::ranges::min(own) >= limit &&
                       stretch_span(rows, of) <= kSettlingSpan &&
                       own.back() <= kSettling * own.front();
  return settles ? rate_quantile(own, 0.5) : limit;
}

bool holds_a_ramp(const TrainingRows& rows, const RowStretch& of) {
  return of.end - of.begin > 2 && stretch_span(rows, of) > kPointWidth;
}

}  // namespace

TrainingRows rows_of_soaks(const TrainingRows& all, double steady_K_per_min) {
  TrainingRows rows = all;
  for (int round = 0; round < kRounds; ++round) {
    RowMask keep = RowMask::Constant(rows.size(), true);
    for (const RowStretch& stretch : following_rows(rows, steady_K_per_min)) {
      if (!holds_a_ramp(rows, stretch)) continue;
      const std::vector<double> own = rates(rows, stretch);
      const double limit = slow_rate(rows, stretch, own);
      for (std::size_t k = 0; k < own.size(); ++k)
        keep(stretch.begin + static_cast<Index>(k)) = own[k] < limit;
    }
    if (keep.all() || !keep.any()) return rows;
    rows = selected(rows, keep);
  }
  return rows;
}

}  // namespace beamgyro::internal
