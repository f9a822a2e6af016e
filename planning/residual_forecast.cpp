// SPDX-License-Identifier: MIT
#include "planning/residual_forecast.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "compensation/models/array_view.h"
#include "compensation/models/lookup_table.h"
#include "linear_algebra/cholesky.h"
#include "linear_algebra/eigenvalues.h"
#include "random/random_stream.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kLeastDevices = 3;   // one that is predicted by two others
constexpr Index kLeastDraws = 4000;  // of devices and noise

// A matrix of normal numbers, from stream `number`.
MatrixXd normal_numbers(Index rows, Index columns, std::uint32_t number) {
  MatrixXd values(rows, columns);
  RandomStream stream(0, number, 0, kResidualForecastStream);
  stream.fill_normal(std::span<double>(
      values.data(), static_cast<std::size_t>(values.size())));
  return values;
}

ResidualForecast quantiles_of(std::vector<double> rms) {
  std::ranges::sort(rms);
  const auto [median, p90, p95] = kForecastShares;
  return {percentile(rms, median), percentile(rms, p90), percentile(rms, p95)};
}

MatrixXd inverse_with_identity(MatrixXd B) {
  B.diagonal().array() += 1.0;
  return Cholesky(B).inverse();
}

// What soaks are taken for, and what they show.
struct Observation {
  MatrixXd H;
  SoakModel::Lagging shown;
  MatrixXd noise;  // root of its covariance
  // What hysteresis adds to each row of H, of each device; or nothing.
  MatrixXd hysteresis = {};
};
// What hysteresis adds to the bias of soaks [deg/s], a row for each device.
MatrixXd hysteresis_of(const SoakModel& model, const std::vector<double>& soaks,
                       const std::vector<double>& way) {
  if (way.empty()) return {};
  const MatrixXd half = model.hysteresis(soaks);
  return half.cols() > 0
             ? MatrixXd(half * array_view(way).matrix().asDiagonal())
             : half;
}

Observation observation(const SoakModel& model,
                        const std::vector<double>& soaks,
                        const SoakErrors& errors) {
  const auto& [lag, noise, way] = errors;
  Observation found = {
      model.equations(soaks),
      model.lagging(soaks, lag.empty() ? std::vector(soaks.size(), 0.0) : lag),
      {}};
  const Index rows = found.H.rows();
  if (noise.size() == 0) {
    found.noise.setIdentity(rows, rows);
  } else {
    found.noise.setZero(rows, noise.cols());
    for (Index k = 0; k < noise.rows(); ++k)
      found.noise.row(k * model.rows_per_soak()) =
          noise.row(k) / model.noise().bias;
  }
  const MatrixXd shown = hysteresis_of(model, soaks, way);
  if (shown.cols() > 0) {
    found.hysteresis.setZero(shown.rows(), rows);
    for (Index k = 0; k < shown.cols(); ++k)
      found.hysteresis.col(k * model.rows_per_soak()) =
          shown.col(k) / model.noise().bias;
  }
  return found;
}

// Appends the root of e^T W e of each row, with the squares of what else is
// left.
void append_rms(const SoakModel& model, const MatrixXd& e,
                const VectorXd& further, std::vector<double>& rms) {
  VectorXd square = (e * model.weight()).cwiseProduct(e).rowwise().sum();
  if (further.size() > 0) square += further;
  for (const double value : square)
    rms.push_back(std::sqrt(std::max(value, 0.0)));
}

// Appends the residual of each device that is predicted by all others.
void append_residuals(const SoakModel& model, const Observation& soaks,
                      const MatrixXd& noise, std::vector<double>& rms) {
  const MatrixXd& H = soaks.H;
  const MatrixXd& c = model.population().coefficients;
  const auto [alpha, beta, gamma] = left_out_device(model.population());
  const MatrixXd B = inverse_with_identity(alpha * H * H.transpose());
  const MatrixXd g = c * H.transpose();  // H c, a row per device
  const MatrixXd Bg = g * B;
  MatrixXd e = gamma * c * model.truth();
  MatrixXd shown = e * soaks.shown.H.transpose() + noise;
  const bool remembers = soaks.hysteresis.size() > 0;
  if (remembers) shown += soaks.hysteresis;
  MatrixXd w = (shown.rowwise() + soaks.shown.shift.transpose()) * B;
  for (Index d = 0; d < c.rows(); ++d) {
    // S^-1 = (B^-1 - beta g g^T)^-1 by Sherman and Morrison.
    const double share = 1.0 - beta * g.row(d).dot(Bg.row(d));
    w.row(d) += beta * g.row(d).dot(w.row(d)) / share * Bg.row(d);
    e.row(d) += beta * g.row(d).dot(w.row(d)) * c.row(d);
  }
  e -= alpha * w * H;
  append_rms(model, e, remembers ? model.hysteresis_square() : VectorXd(), rms);
}

// Calls append(noise, rms) in every round, where `noise` has a row a device and
// the covariance of the root.
template <typename Append>
ResidualDraws draws_of_devices(const SoakModel& model, const MatrixXd& root,
                               const Append& append) {
  const Index devices = model.population().coefficients.rows();
  const Index rounds = (kLeastDraws + devices - 1) / devices;
  ResidualDraws draws{static_cast<std::size_t>(devices), {}};
  for (Index round = 0; round < rounds; ++round)
    append(normal_numbers(devices, root.cols(),
                          static_cast<std::uint32_t>(round)) *
               root.transpose(),
           draws.rms);
  return draws;
}

// Lines between values at increasing soaks, as weights of the values: one row
// for each temperature.
MatrixXd line_weights(const ArrayXd& temperatures,
                      const std::vector<double>& soaks) {
  const auto count = static_cast<Index>(soaks.size());
  LookupTable lines{array_view(soaks), {}};
  MatrixXd weights(temperatures.size(), count);
  for (Index k = 0; k < count; ++k) {
    lines.values = VectorXd::Unit(count, k).array();
    weights.col(k) = lines.predict(temperatures);
  }
  return weights;
}

ResidualForecast forecast_of_process(const SoakModel& model,
                                     const Observation& soaks) {
  const MatrixXd K = inverse_with_identity(soaks.H.transpose() * soaks.H) *
                     soaks.H.transpose();
  const MatrixXd x =
      normal_numbers(kLeastDraws, model.modes(), 0) * model.truth();
  const MatrixXd shown = x * soaks.shown.H.transpose() +
                         normal_numbers(kLeastDraws, soaks.noise.cols(), 1) *
                             soaks.noise.transpose();
  std::vector<double> rms;
  append_rms(
      model,
      x - (shown.rowwise() + soaks.shown.shift.transpose()) * K.transpose(), {},
      rms);
  return quantiles_of(std::move(rms));
}

}  // namespace

Eigen::MatrixXd slow_noise_root(const SlowNoise& noise,
                                const std::vector<double>& soaks,
                                const ChamberTime& time, bool start_row) {
  const auto count = static_cast<Eigen::Index>(soaks.size());
  const std::vector<Visit> stops = visits(soaks, time);
  const Eigen::Index rows = count + (start_row ? 1 : 0);
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(rows, 1 + count + rows);
  root.col(0).setConstant(noise.turn_on);
  root.rightCols(rows).diagonal().setConstant(noise.own);
  for (Eigen::Index k = 0; k < count; ++k) {
    double before = 0.0;
    for (Eigen::Index step = 0; step < count; ++step) {
      const Visit& stop = stops[static_cast<std::size_t>(step)];
      root(k, 1 + step) = noise.walk * std::sqrt(stop.end - before);
      before = stop.end;
      if (stop.temperature == soaks[static_cast<std::size_t>(k)]) break;
    }
  }
  return root;
}

void add_noise(const VectorXd& of_soaks, MatrixXd& root) {
  auto own = root.rightCols(root.rows()).diagonal();
  for (Index k = 0; k < of_soaks.size(); ++k)
    own(k) = std::hypot(own(k), of_soaks(k));
}

ForecastBasis forecast_basis(const Population& population) {
  return population.coefficients.rows() >= kLeastDevices &&
                 population.devices >= population.coefficients.rows()
             ? ForecastBasis::kDevices
             : ForecastBasis::kGaussian;
}

MatrixXd root_without(const SoakModel& model, const Fold& fold) {
  const MatrixXd& c = model.population().coefficients;
  MatrixXd others(c.rows(), c.cols());
  Index count = 0;
  for (Index d = 0; d < c.rows(); ++d)
    if (static_cast<std::size_t>(d) % fold.folds != fold.first)
      others.row(count++) = c.row(d);
  others.conservativeResize(count, Eigen::NoChange);
  others.rowwise() -= others.colwise().mean().eval();
  MatrixXd covariance =
      others.transpose() * others / static_cast<double>(count - 1);
  // Own parts, in which the devices have no coefficients, are independent.
  for (Index k = 0; k < c.cols(); ++k)
    if ((c.col(k).array() == 0.0).all()) covariance(k, k) = 1.0;
  const SymmetricEigen eigen = symmetric_eigen(covariance);
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

void take_fold(const ResidualDraws& of_fold, const Fold& fold,
               ResidualDraws& all) {
  for (std::size_t k = 0; k < all.rms.size(); ++k)
    if (k % all.devices % fold.folds == fold.first) all.rms[k] = of_fold.rms[k];
}

ResidualForecast forecast_of(const ResidualDraws& draws) {
  return quantiles_of(draws.rms);
}

ResidualDraws residual_draws(const SoakModel& model,
                             const std::vector<double>& soaks,
                             const SoakErrors& errors) {
  const Observation shown = observation(model, soaks, errors);
  return draws_of_devices(model, shown.noise,
                          [&](const MatrixXd& noise, std::vector<double>& rms) {
                            append_residuals(model, shown, noise, rms);
                          });
}

ResidualDraws straight_line_draws(const SoakModel& model,
                                  const std::vector<double>& soaks,
                                  const SoakErrors& errors) {
  const auto count = static_cast<Index>(soaks.size());
  const ArrayXd grid = model.range_grid();
  const std::vector<double> lag =
      errors.lag.empty() ? std::vector(soaks.size(), 0.0) : errors.lag;
  const MatrixXd root =
      errors.noise.size() > 0
          ? errors.noise
          : MatrixXd(model.noise().bias * MatrixXd::Identity(count, count));
  const MatrixXd lines = line_weights(grid, soaks);
  const SoakModel::Bias shown = model.bias(soaks, lag);
  const SoakModel::Bias all =
      model.bias({grid.begin(), grid.end()},
                 std::vector(static_cast<std::size_t>(grid.size()), 0.0));
  const VectorXd mean = all.mean - lines * shown.mean;
  // Of the devices without the noise of their training, a row each.
  const MatrixXd curves = model.population().coefficients * model.truth() *
                          (all.modes - lines * shown.modes).transpose();
  const MatrixXd hysteresis = hysteresis_of(model, soaks, errors.way);
  const bool remembers = hysteresis.size() > 0;
  return draws_of_devices(
      model, root, [&](const MatrixXd& noise, std::vector<double>& rms) {
        MatrixXd left = curves - noise * lines.transpose();
        left.rowwise() += mean.transpose();
        if (remembers) left -= hysteresis * lines.transpose();
        VectorXd square =
            left.rowwise().squaredNorm() / static_cast<double>(left.cols());
        if (remembers) square += model.hysteresis_square();
        for (const double one : square) rms.push_back(std::sqrt(one));
      });
}

ResidualForecast forecast_residual(const SoakModel& model,
                                   const std::vector<double>& soaks,
                                   const SoakErrors& errors) {
  return forecast_basis(model.population()) == ForecastBasis::kDevices
             ? forecast_of(residual_draws(model, soaks, errors))
             : forecast_of_process(model, observation(model, soaks, errors));
}

}  // namespace beamgyro::internal
