// SPDX-License-Identifier: MIT
#include "planning/soak_model.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "compensation/methods/population_own.h"
#include "compensation/models/array_view.h"
#include "linear_algebra/eigenvalues.h"
#include "linear_algebra/linear_systems.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kRangeStep = 1.0;  // [K], over which the residual is averaged
// [-], of the variance of noise in a direction: curves that differ by less
// there are its rounding.
constexpr double kLeastTruth = 1e-3;

// A column for each step of a walk: it moves all values of the bias beyond it.
MatrixXd steps_of_walk(const Population& population) {
  const Index steps = population.grid() - 1;
  MatrixXd walk = MatrixXd::Zero(population.modes.rows(), steps);
  for (Index step = 0; step < steps; ++step)
    walk.col(step).segment(step + 1, steps - step).setOnes();
  return walk;
}

MatrixXd variance_of_largest_walk(const Population& population) {
  const MatrixXd shown =
      solve_system(population.modes, steps_of_walk(population));
  const MatrixXd V = shown * shown.transpose();
  return V / symmetric_eigen(V).values.maxCoeff();
}

// A root of the covariance of noise on the grid, of the mean of the sweeps.
MatrixXd noise_of_sweeps(const Population& population, const SlowNoise& noise) {
  const Index grid = population.grid(), steps = grid - 1;
  const auto& [count, seconds_per_K] = *population.sweeps;
  const TemperatureRange range = population.range();
  const double step = seconds_per_K * (range.highest - range.lowest) /
                      static_cast<double>(steps);
  MatrixXd root = MatrixXd::Zero(population.modes.rows(), 1 + steps + grid);
  root.col(0).head(grid).setConstant(noise.turn_on);
  root.middleCols(1, steps) =
      noise.walk * std::sqrt(step) * steps_of_walk(population);
  root.topRightCorner(grid, grid).diagonal().setConstant(noise.own);
  return root / std::sqrt(count);
}

// In the coordinates of c, of the directions in which the curves differ.
// Channels count by their spread, because their units differ.
MatrixXd variance_of_sweeps(const Population& population,
                            const SlowNoise& noise) {
  const Index grid = population.grid();
  MatrixXd modes = population.modes;
  MatrixXd root = noise_of_sweeps(population, noise);
  for (Index first = 0; first < modes.rows(); first += grid) {
    const double unit = curve_spread(population, first / grid);
    modes.middleRows(first, grid) /= unit;
    root.middleRows(first, grid) /= unit;
  }
  const SymmetricEigen curves = symmetric_eigen(modes.transpose() * modes);
  MatrixXd shown = curves.vectors.transpose() * modes.transpose() * root;
  for (Index k = 0; k < shown.rows(); ++k) {
    const double variance = curves.values(k);
    const double noise_square = shown.row(k).squaredNorm();
    // Over the variance; the variance of the noise is noise_square / variance.
    if (variance * variance > kLeastTruth * noise_square)
      shown.row(k) /= variance;
    else
      shown.row(k).setZero();
  }
  const MatrixXd of_c = curves.vectors * shown;
  return of_c * of_c.transpose();
}

}  // namespace

MatrixXd truth_root(const Population& population,
                    const std::optional<SlowNoise>& of_sweep) {
  const Index modes = population.modes.cols();
  const MatrixXd V =
      of_sweep && population.sweeps ? variance_of_sweeps(population, *of_sweep)
      : modes == population.modes.rows() ? variance_of_largest_walk(population)
                                         : MatrixXd::Zero(modes, modes);
  const SymmetricEigen left =
      symmetric_eigen(MatrixXd::Identity(V.rows(), V.cols()) - V);
  return left.vectors * left.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         left.vectors.transpose();
}

SoakModel::SoakModel(Population population, SensorOfChamber sensor,
                     const SoakModelOptions& options)
    : population_(std::move(population)),
      sensor_(std::move(sensor)),
      options_(options) {
  if (modes() == 0)
    throw std::invalid_argument(
        "the devices of the population are all alike: there is nothing that a "
        "soak could tell; expected a population whose devices differ");
  for (Index curve = 0; curve < rows_per_soak(); ++curve)
    noise_.push_back(point_noise_of(population_, curve, noise()));
  truth_ = truth_root(population_, options_.of_sweep);
  add_own_modes();
  const Index grid = population_.grid();
  for (Index curve = 0; curve < rows_per_soak(); ++curve) {
    means_.push_back(bias_curve(
        population_, population_.mean.segment(curve * grid, grid).array()));
    for (const auto& mode : population_.modes.colwise())
      modes_.push_back(
          bias_curve(population_, mode.segment(curve * grid, grid).array()));
  }
  weigh_range();
}

void SoakModel::weigh_range() {
  const MatrixXd bias = values(0, known_sensor(range_grid()));
  weight_ = bias.transpose() * bias / static_cast<double>(bias.rows());
  const ArrayXd grid = range_grid();
  const MatrixXd half = hysteresis({grid.begin(), grid.end()});
  if (half.cols() > 0)
    hysteresis_square_ =
        half.rowwise().squaredNorm() / static_cast<double>(half.cols());
}

MatrixXd SoakModel::hysteresis(const std::vector<double>& chamber) const {
  const MatrixXd half = true_hysteresis(population_);
  if (half.size() == 0) return {};
  const ArrayXd sensor = known_sensor(array_view(chamber));
  MatrixXd weights(sensor.size(), half.cols());
  for (Index g = 0; g < half.cols(); ++g)
    weights.col(g) =
        bias_curve(population_, Eigen::VectorXd::Unit(half.cols(), g).array())
            .predict(sensor);
  return half * weights.transpose();
}

SoakModel SoakModel::over(const TemperatureRange& range) const {
  SoakModel other = *this;
  other.options_.range = range;
  other.weigh_range();
  return other;
}

void SoakModel::add_own_modes() {
  const Index before = modes();
  population_.modes = all_modes(population_);
  population_.own.clear();
  const Index added = modes() - before;
  truth_.conservativeResize(modes(), modes());
  truth_.rightCols(added).setZero();
  truth_.bottomRows(added).setZero();
  truth_.bottomRightCorner(added, added).setIdentity();
  MatrixXd& c = population_.coefficients;
  if (c.rows() == 0) return;
  c.conservativeResize(Eigen::NoChange, modes());
  c.rightCols(added).setZero();
}

// One column for each mode, one row for each temperature of the sensor.
MatrixXd SoakModel::values(Index curve, const ArrayXd& sensor) const {
  MatrixXd found(sensor.size(), modes());
  for (Index m = 0; m < modes(); ++m)
    found.col(m) =
        modes_[static_cast<std::size_t>(curve * modes() + m)].predict(sensor);
  return found;
}

ArrayXd SoakModel::range_grid() const {
  const auto [lowest, highest] = options_.range;
  const auto steps =
      static_cast<Index>(std::ceil((highest - lowest) / kRangeStep - 1e-9));
  return ArrayXd::LinSpaced(steps + 1, lowest, highest);
}

bool SoakModel::reaches(double chamber) const {
  const double sensor = sensor_(ArrayXd::Constant(1, chamber))(0);
  const auto [lowest, highest] = population_.range();
  return sensor >= lowest - kReach && sensor <= highest + kReach;
}

ArrayXd SoakModel::known_sensor(const ArrayXd& chamber) const {
  const auto [lowest, highest] = population_.range();
  const ArrayXd sensor = sensor_(chamber);
  for (Index k = 0; k < sensor.size(); ++k)
    if (!(sensor(k) >= lowest - kReach && sensor(k) <= highest + kReach))
      throw std::invalid_argument(fmt::format(
          "in a chamber at {:g} degC the sensor shows {:.2f} degC, and the "
          "population knows {:.2f} to {:.2f} degC; expected temperatures of "
          "the chamber for which it lies within these",
          chamber(k), sensor(k), lowest, highest));
  return sensor.max(lowest).min(highest);
}

Index SoakModel::rows_per_soak() const {
  return options_.bias_only
             ? 1
             : 1 + static_cast<Index>(population_.channels.size());
}

PointNoise SoakModel::noise() const {
  return options_.noise.value_or(PointNoise{population_.point_noise});
}

MatrixXd SoakModel::rows(const ArrayXd& sensor) const {
  const Index curves = rows_per_soak();
  MatrixXd H(curves * sensor.size(), modes());
  for (Index curve = 0; curve < curves; ++curve) {
    const MatrixXd own =
        values(curve, sensor) / noise_[static_cast<std::size_t>(curve)];
    for (Index k = 0; k < own.rows(); ++k)
      H.row(k * curves + curve) = own.row(k);
  }
  return H;
}

MatrixXd SoakModel::equations(const std::vector<double>& chamber) const {
  return chamber.empty() ? MatrixXd(0, modes())
                         : rows(known_sensor(array_view(chamber)));
}

ArrayXd SoakModel::known_beam(const ArrayXd& sensor,
                              const std::vector<double>& lag) const {
  const auto [lowest, highest] = population_.range();
  return (sensor + array_view(lag)).max(lowest).min(highest);
}

SoakModel::Bias SoakModel::bias(const std::vector<double>& chamber,
                                const std::vector<double>& lag) const {
  const ArrayXd beam = known_beam(known_sensor(array_view(chamber)), lag);
  return {means_.front().predict(beam).matrix(), values(0, beam)};
}

Eigen::VectorXd SoakModel::slope(const std::vector<double>& chamber) const {
  constexpr double kStep = 0.5;  // [K]
  const Bias above = bias(chamber, std::vector(chamber.size(), kStep));
  const Bias below = bias(chamber, std::vector(chamber.size(), -kStep));
  const Eigen::ArrayXd square =
      (above.mean - below.mean).array().square() +
      (above.modes - below.modes).rowwise().squaredNorm().array();
  return square.sqrt() / (2.0 * kStep);
}

SoakModel::Lagging SoakModel::lagging(const std::vector<double>& chamber,
                                      const std::vector<double>& lag) const {
  const ArrayXd sensor = known_sensor(array_view(chamber));
  const ArrayXd beam = known_beam(sensor, lag);
  Lagging found{rows(beam), Eigen::VectorXd(rows_per_soak() * sensor.size())};
  for (Index curve = 0; curve < rows_per_soak(); ++curve) {
    const CubicSpline& mean = means_[static_cast<std::size_t>(curve)];
    const ArrayXd shift = (mean.predict(beam) - mean.predict(sensor)) /
                          noise_[static_cast<std::size_t>(curve)];
    for (Index k = 0; k < shift.size(); ++k)
      found.shift(k * rows_per_soak() + curve) = shift(k);
  }
  return found;
}

}  // namespace beamgyro::internal
