// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/sigma_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

// Of the largest amplitude that a row asks for; what is less counts as none.
constexpr double kLeastShare = 1e-9;

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

// Mean of residual^2 / (others^2 + (a scale)^2) over groups of equal weight.
double mean_normalised_square(const std::map<int, std::vector<Index>>& by_group,
                              const ResidualRows& rows, const ArrayXd& others,
                              const ArrayXd& scale, double a) {
  double sum = 0.0;
  for (const auto& [group, own] : by_group) {
    double squares = 0.0;
    for (const Index k : own)
      squares += std::pow(rows.residual(k), 2) /
                 (std::pow(others(k), 2) + std::pow(a * scale(k), 2));
    sum += squares / static_cast<double>(own.size());
  }
  return sum / static_cast<double>(by_group.size());
}

// Independent residuals of the groups [-].
double degrees_of_freedom(const std::map<int, std::vector<Index>>& by_group,
                          const ResidualRows& rows) {
  double sum = 0.0;
  for (const auto& [group, own] : by_group) {
    const auto [lowest, highest] = std::ranges::minmax(
        own, {}, [&](Index k) { return rows.temperature(k); });
    sum +=
        std::max(1.0, (rows.temperature(highest) - rows.temperature(lowest)) /
                          rows.correlation);
  }
  return sum;
}

// What an amplitude from few groups has to be widened by, for intervals that
// hold kSigmaLevel of normal residuals.
double widening(const std::map<int, std::vector<Index>>& by_group,
                const ResidualRows& rows) {
  if (by_group.size() >= std::size_t{kLeastConformalGroups}) return 1.0;
  constexpr double kBeyondLevel = 0.5 * (1.0 - kSigmaLevel);
  const boost::math::students_t_distribution<double> student(
      degrees_of_freedom(by_group, rows));
  return quantile(complement(student, kBeyondLevel)) /
         quantile(complement(boost::math::normal_distribution<double>(),
                             kBeyondLevel));
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

ArrayXd sigma_at_rows(const BiasSigma& sigma, const ResidualRows& rows) {
  ArrayXd result(rows.size());
  for (Index k = 0; k < rows.size(); ++k)
    result(k) = sigma.at(rows.temperature(k), rows.since_power_on(k),
                         rows.temperature_rate(k));
  return result;
}

std::string calibration_words(int groups) {
  if (groups >= kLeastConformalGroups)
    return "mean square: that of residual over sigma is 1";
  return fmt::format(
      "mean square: that of residual over sigma is 1 for the residuals of {} "
      "groups, widened by Student's t; a quantile takes {}",
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

double mean_square_amplitude(const ResidualRows& rows, const RowMask& mask,
                             const ArrayXd& others, const ArrayXd& scale) {
  const auto by_group = rows_by_group(rows, mask);
  if (by_group.empty())
    throw std::invalid_argument("no rows to calibrate a sigma on");
  const auto excess = [&](double a) {
    return mean_normalised_square(by_group, rows, others, scale, a) - 1.0;
  };
  // With this amplitude every row has z^2 <= 1.
  double high = 0.0;
  for (Index k = 0; k < rows.size(); ++k)
    if (mask(k)) high = std::max(high, std::abs(rows.residual(k) / scale(k)));
  const double least = high * kLeastShare;
  if (!(high > 0.0) || excess(least) <= 0.0) return 0.0;
  std::uintmax_t steps = 100;
  const auto [below, above] = boost::math::tools::toms748_solve(
      excess, least, high, boost::math::tools::eps_tolerance<double>(50),
      steps);
  return 0.5 * (below + above) * widening(by_group, rows);
}

double conformal_half_width(const ResidualRows& rows, const ArrayXd& sigma) {
  const auto by_group =
      rows_by_group(rows, RowMask::Constant(rows.size(), true));
  if (by_group.size() < std::size_t{kLeastConformalGroups}) return 0.0;
  std::vector<WeightedScore> scores;
  for (const auto& [group, own] : by_group) {
    const double weight = 1.0 / (static_cast<double>(own.size()) *
                                 static_cast<double>(by_group.size() + 1));
    for (const Index k : own)
      scores.push_back({std::abs(rows.residual(k)) / sigma(k), weight});
  }
  return quantile_of(std::move(scores));
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
        mean_square_amplitude(unit, ramps, others, rows.temperature_rate)};
    others =
        (others.square() +
         (sigma.temperature_rate->amplitude * rows.temperature_rate).square())
            .sqrt();
  }
  if (warm_ups.any())
    sigma.power_on = SigmaTerm{
        mean_square_amplitude(unit, warm_ups, others, rows.since_power_on)};
}

void calibrate(BiasSigma& sigma, const ResidualRows& rows) {
  const RowMask soaks = soak_rows(rows);
  const bool any_soak = soaks.any();
  const RowMask mask = any_soak ? soaks : RowMask::Constant(rows.size(), true);
  sigma.factor = mean_square_amplitude(rows, mask, ArrayXd::Zero(rows.size()),
                                       curve_at_rows(sigma, rows));
  // Residuals of 0 promise nothing.
  if (!(sigma.factor > 0.0)) sigma.factor = 1.0;
  const int groups = groups_among(rows, mask);
  calibrate_terms(sigma, rows);
  if (!any_soak && sigma.temperature_rate)
    sigma.temperature_rate->amplitude = 0.0;
  const double half_width =
      conformal_half_width(rows, sigma_at_rows(sigma, rows));
  sigma.calibration = {calibration_words(groups), rows.by,
                       static_cast<std::size_t>(groups),
                       half_width > 0.0 ? kSigmaLevel : 0.0, half_width};
}

}  // namespace beamgyro::internal
