// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/sigma_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

// Quantile 0.95 of Student's t with 1 ... 8 degrees of freedom.
constexpr double kStudentQuantiles[] = {6.314, 2.920, 2.353, 2.132,
                                        2.015, 1.943, 1.895, 1.860};

struct WeightedScore {
  double value, weight;
};

std::map<int, std::vector<Index>> rows_by_group(const ResidualRows& rows,
                                                const RowMask& mask) {
  std::map<int, std::vector<Index>> found;
  for (Index k = 0; k < rows.size(); ++k)
    if (mask(k)) found[rows.group(k)].push_back(k);
  return found;
}

// The amplitude for which the interval of `half_width` sigmas just covers.
double amplitude_asked_for(double residual, double half_width, double others,
                           double scale) {
  const double needed = residual / half_width;
  return std::sqrt(std::max(needed * needed - others * others, 0.0)) /
         std::abs(scale);
}

double quantile_of(std::vector<WeightedScore> scores) {
  constexpr double kRounding = 1e-9;
  std::ranges::sort(scores, {}, &WeightedScore::value);
  double sum = 0.0;
  for (const WeightedScore& score : scores) {
    sum += score.weight;
    if (sum >= kSigmaLevel - kRounding) return score.value;
  }
  return scores.back().value;
}

ArrayXd curve_at_rows(const BiasSigma& sigma, const ResidualRows& rows) {
  return rows.temperature.unaryExpr(
      [&](double T) { return sigma.curve_at(T); });
}

std::string calibration_words(int groups) {
  if (groups >= kLeastConformalGroups)
    return fmt::format(
        "conformal: {:g} % of the residuals of a further group are within "
        "{:.3f} sigma",
        100.0 * kSigmaLevel, kSigmaHalfWidth);
  return fmt::format(
      "root mean square of the residuals of {} groups, widened by Student's t; "
      "a quantile takes {}",
      groups, kLeastConformalGroups);
}

}  // namespace

RowMask warm_up_rows(const ResidualRows& rows) {
  return rows.since_power_on >= kWarmUpShare;
}

RowMask ramp_rows(const ResidualRows& rows) {
  return rows.temperature_rate.abs() >= kRampRate && !warm_up_rows(rows);
}

RowMask soak_rows(const ResidualRows& rows) {
  return rows.temperature_rate.abs() < kRampRate && !warm_up_rows(rows);
}

int groups_among(const ResidualRows& rows, const RowMask& mask) {
  return static_cast<int>(rows_by_group(rows, mask).size());
}

double covering_amplitude(const ResidualRows& rows, const RowMask& mask,
                          const ArrayXd& others, const ArrayXd& scale) {
  const auto by_group = rows_by_group(rows, mask);
  if (by_group.empty())
    throw std::invalid_argument("no rows to calibrate a sigma on");
  const std::size_t groups = by_group.size();
  const bool conformal = groups >= kLeastConformalGroups;
  std::vector<WeightedScore> scores;
  double squares = 0.0;
  for (const auto& [group, own] : by_group) {
    const auto count = static_cast<double>(own.size());
    const double weight = 1.0 / (count * static_cast<double>(groups + 1));
    for (const Index k : own) {
      const double asked =
          amplitude_asked_for(rows.residual(k), conformal ? kSigmaHalfWidth : 1,
                              others(k), scale(k));
      scores.push_back({asked, weight});
      squares += asked * asked / (count * static_cast<double>(groups));
    }
  }
  if (conformal) return quantile_of(std::move(scores));
  return std::sqrt(squares) * kStudentQuantiles[groups - 1] / kSigmaHalfWidth;
}

void calibrate_terms(BiasSigma& sigma, const ResidualRows& rows) {
  ResidualRows unit = rows;
  unit.residual /= sigma.factor;
  ArrayXd others = curve_at_rows(sigma, rows);
  sigma.temperature_rate.reset();
  sigma.power_on.reset();
  const RowMask ramps = ramp_rows(rows), warm_ups = warm_up_rows(rows);
  if (ramps.any()) {
    sigma.temperature_rate = SigmaTerm{
        covering_amplitude(unit, ramps, others, rows.temperature_rate)};
    others =
        (others.square() +
         (sigma.temperature_rate->amplitude * rows.temperature_rate).square())
            .sqrt();
  }
  if (warm_ups.any())
    sigma.power_on = SigmaTerm{
        covering_amplitude(unit, warm_ups, others, rows.since_power_on)};
}

void calibrate(BiasSigma& sigma, const ResidualRows& rows) {
  const RowMask soaks = soak_rows(rows);
  const bool any_soak = soaks.any();
  const RowMask mask = any_soak ? soaks : RowMask::Constant(rows.size(), true);
  sigma.factor = covering_amplitude(rows, mask, ArrayXd::Zero(rows.size()),
                                    curve_at_rows(sigma, rows));
  // Residuals of 0 promise nothing.
  if (!(sigma.factor > 0.0)) sigma.factor = 1.0;
  const int groups = groups_among(rows, mask);
  sigma.calibration = {calibration_words(groups), rows.by,
                       static_cast<std::size_t>(groups),
                       groups >= kLeastConformalGroups ? kSigmaLevel : 0.0};
  calibrate_terms(sigma, rows);
  if (!any_soak) sigma.temperature_rate.reset();
}

}  // namespace beamgyro::internal
