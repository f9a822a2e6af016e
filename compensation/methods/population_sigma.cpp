// SPDX-License-Identifier: MIT
// The sigma of a population and of devices adapted from it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/methods/population.h"
#include "compensation/models/array_view.h"
#include "compensation/models/bias_function.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kLeastSpread = 1e-6;  // [deg/s], of devices that are equal
// Of the posterior deviation, where the noise of points alone explains all.
constexpr double kLeastFactor = 0.5;
constexpr int kSoakCounts[] = {3, 5};  // that devices are adapted from

int device_count(const TrainingRows& rows) {
  return rows.size() > 0 ? rows.device.maxCoeff() + 1 : 0;
}

TrainingRows rows_of_device(const TrainingRows& rows, int device) {
  return selected(rows, rows.device == device);
}

// Appends rows, the arrays of which are still vectors.
struct ResidualCollector {
  std::vector<double> temperature, residual, since, rate;
  std::vector<int> group;

  void add(double T, double e, double x, double r, int g) {
    temperature.push_back(T);
    residual.push_back(e);
    since.push_back(x);
    rate.push_back(r);
    group.push_back(g);
  }

  ResidualRows rows() const {
    return {array_view(temperature), array_view(residual), array_view(since),
            array_view(rate),        array_view(group),    "device"};
  }
};

// The rows within half a point's width of the one nearest to each of `count`
// temperatures in the middle of as many equal parts of the grid.
RowMask evenly_spaced(const Population& population, const ArrayXd& T,
                      int count) {
  const auto [lowest, highest] = population.range();
  RowMask chosen = RowMask::Constant(T.size(), false);
  for (int k = 0; k < count; ++k) {
    const double wanted = lowest + (highest - lowest) * (k + 0.5) / count;
    Index nearest = 0;
    (T - wanted).abs().minCoeff(&nearest);
    chosen = chosen || (T - T(nearest)).abs() < kPointWidth / 2.0;
  }
  return chosen;
}

void add_predictions(const Population& population,
                     const std::vector<Input>& inputs, const TrainingRows& own,
                     int count, ResidualCollector& scored, ArrayXd& scales) {
  const RowMask adapted_to = evenly_spaced(population, own.temperature, count);
  const AdaptedBias adapted =
      adapted_bias(population, inputs, selected(own, adapted_to),
                   PointNoise{population.point_noise});
  const ArrayXd predicted =
      bias_curve(population, adapted.mean).predict(own.temperature);
  const LookupTable deviation{population.temperatures, adapted.deviation};
  const Index before = scales.size();
  Index added = 0;
  scales.conservativeResize(before + own.size());
  for (Index k = 0; k < own.size(); ++k) {
    if (adapted_to(k) || own.beyond_range(k) > 0.0) continue;
    scored.add(own.temperature(k), own.bias(k) - predicted(k), 0.0, 0.0,
               own.device(k));
    scales(before + added++) = deviation.at(own.temperature(k));
  }
  scales.conservativeResize(before + added);
}

void add_own_residuals(const TrainingRows& own, double grid_K,
                       ResidualCollector& found) {
  const Index last = own.inputs.cols() - 1;
  const ArrayXd since = own.inputs.col(last - 1), rate = own.inputs.col(last);
  const RowMask still = rate.abs() < kRampRate && since < kWarmUpShare;
  const TrainingRows soaks = selected(own, still);
  if (soaks.size() == 0) return;
  const CubicSpline curve = [&] {
    const ArrayXd knots = spline_knots(soaks.temperature, grid_K);
    return fit_cubic_spline(soaks.temperature, soaks.bias, knots,
                            SplineEnd::kNotAKnot);
  }();
  const double lowest = curve.knots(0);
  const double highest = curve.knots(curve.knots.size() - 1);
  const ArrayXd predicted =
      curve.predict(own.temperature.max(lowest).min(highest));
  for (Index k = 0; k < own.size(); ++k) {
    const double T = own.temperature(k);
    // A warm-up leads to the first soak and may have no other.
    if ((T >= lowest && T <= highest) || since(k) >= kWarmUpShare)
      found.add(T, own.bias(k) - predicted(k), since(k), rate(k),
                own.device(k));
  }
}

// RMS of a device's soaks about its own spline: noise without lag.
double soak_rms(const ResidualRows& rows) {
  const RowMask soaks = soak_rows(rows);
  if (!soaks.any()) return 0.0;
  return mean_square_amplitude(rows, soaks, ArrayXd::Zero(rows.size()),
                               ArrayXd::Ones(rows.size()));
}

}  // namespace

ResidualRows own_curve_residuals(const TrainingRows& rows, double grid_K,
                                 std::vector<std::string>& remarks) {
  ResidualCollector found;
  int left_out = 0;
  std::string reason;
  for (int device = 0; device < device_count(rows); ++device) try {
      add_own_residuals(rows_of_device(rows, device), grid_K, found);
    } catch (const UndeterminedFit& error) {
      ++left_out;
      reason = error.what();
    }
  if (left_out > 0)
    remarks.push_back(fmt::format(
        "sigma on ramps and in warm-ups: {} of {} held-out devices are left "
        "out, the last because {}",
        left_out, device_count(rows), reason));
  return found.rows();
}

std::optional<AdaptationSigma> adaptation_sigma(
    const Population& population, const std::vector<Input>& inputs,
    const TrainingRows& soaks, const ResidualRows& lagging) {
  ResidualCollector scored;
  ArrayXd scales(0);
  for (int device = 0; device < device_count(soaks); ++device) {
    const TrainingRows own = rows_of_device(soaks, device);
    for (const int count : kSoakCounts)
      if (own.size() > 0)
        add_predictions(population, inputs, own, count, scored, scales);
  }
  const ResidualRows rows = scored.rows();
  const RowMask all = RowMask::Constant(rows.size(), true);
  if (rows.size() == 0 || !(scales > 0.0).all()) return std::nullopt;
  AdaptationSigma result;
  const double of_a_point =
      std::hypot(population.point_noise, 0.5 * hysteresis_rms(population));
  result.factor = mean_square_amplitude(
      rows, all, ArrayXd::Constant(rows.size(), of_a_point), scales);
  result.devices = groups_among(rows, all);
  result.factor = std::max(result.factor, kLeastFactor);
  result.half_width = conformal_half_width(
      rows,
      ((result.factor * scales).square() + of_a_point * of_a_point).sqrt());
  BiasSigma terms;
  terms.factor = result.factor;
  terms.curve = {ArrayXd::Zero(1),
                 ArrayXd::Constant(1, soak_rms(lagging) / result.factor)};
  calibrate_terms(terms, lagging);
  result.power_on = terms.power_on;
  result.temperature_rate = terms.temperature_rate;
  return result;
}

BiasSigma adapted_sigma(const Population& population, const ArrayXd& deviation,
                        double run_noise) {
  BiasSigma sigma;
  sigma.source = SigmaSource::kPosterior;
  sigma.calibration.method = "none: the population has no devices to tell";
  if (const auto& learned = population.sigma) {
    sigma.factor = learned->factor;
    sigma.power_on = learned->power_on;
    sigma.temperature_rate = learned->temperature_rate;
    sigma.calibration = {
        fmt::format("of the population, on devices adapted from {} and {} "
                    "soaks and predicted at the others",
                    kSoakCounts[0], kSoakCounts[1]),
        "device", static_cast<std::size_t>(learned->devices),
        learned->half_width > 0.0 ? kSigmaLevel : 0.0, learned->half_width};
  }
  const double hysteresis = hysteresis_rms(population);
  const double run =
      std::sqrt(2.0 * run_noise * run_noise + 0.5 * hysteresis * hysteresis) /
      sigma.factor;
  sigma.curve = {population.temperatures,
                 (deviation.square() + run * run).sqrt()};
  return sigma;
}

BiasSigma population_sigma(const Population& population) {
  BiasSigma sigma;
  sigma.source = SigmaSource::kPosterior;
  sigma.calibration.method = "none: no devices were held out";
  sigma.curve = {population.temperatures,
                 population.modes.topRows(population.grid())
                     .rowwise()
                     .norm()
                     .array()
                     .max(kLeastSpread)};
  return sigma;
}

}  // namespace beamgyro::internal
