// SPDX-License-Identifier: MIT
#include "compensation/methods/population.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>

#include "compensation/methods/population_equations.h"
#include "compensation/methods/population_own.h"
#include "compensation/rows/row_groups.h"
#include "linear_algebra/eigenvalues.h"
#include "linear_algebra/least_squares.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLeastSteps = 3;  // of the grid: a spline has four knots
// Modes with less of the largest variance are rounding.
constexpr double kLeastVariance = 1e-14;

// Rows of each device that has any.
using RowsOfDevices = std::vector<std::vector<Index>>;
RowsOfDevices rows_of_devices(const TrainingRows& rows) {
  RowsOfDevices found(static_cast<std::size_t>(rows.device.maxCoeff() + 1));
  for (Index k = 0; k < rows.size(); ++k)
    found[static_cast<std::size_t>(rows.device(k))].push_back(k);
  std::erase_if(found, [](const auto& own) { return own.empty(); });
  return found;
}

ArrayXd common_grid(const TrainingRows& rows, const RowsOfDevices& devices,
                    double grid_K) {
  double lowest = -HUGE_VAL, highest = HUGE_VAL;
  for (const std::vector<Index>& own : devices) {
    const ArrayXd T = rows.temperature(own);
    lowest = std::max(lowest, T.minCoeff());
    highest = std::min(highest, T.maxCoeff());
  }
  if (!(highest - lowest >= kLeastSteps * grid_K))
    throw std::invalid_argument(fmt::format(
        "the devices share the temperatures {:.2f} to {:.2f} degC; a "
        "population needs {} steps of grid_K, {} K, or more in common",
        lowest, highest, kLeastSteps, grid_K));
  const auto steps = static_cast<Index>(std::ceil((highest - lowest) / grid_K));
  return ArrayXd::LinSpaced(steps + 1, lowest, highest);
}

// Bias and channels of one device on the grid, one below the other.
VectorXd curves_of(const TrainingRows& rows, const std::vector<Index>& own,
                   const ArrayXd& grid, double grid_K) {
  const ArrayXd T = rows.temperature(own);
  const ArrayXd knots = spline_knots(T, grid_K);
  const auto on_grid = [&](const ArrayXd& values) {
    return fit_cubic_spline(T, values, knots, SplineEnd::kNotAKnot)
        .predict(grid);
  };
  const Index curves = rows.inputs.cols();  // the temperature is none
  VectorXd stacked(curves * grid.size());
  stacked.head(grid.size()) = on_grid(rows.bias(own));
  for (Index i = 1; i < curves; ++i)
    stacked.segment(i * grid.size(), grid.size()) =
        on_grid(rows.inputs.col(i)(own));
  return stacked;
}

// One column per device.
MatrixXd curves_of_all(const TrainingRows& rows, const RowsOfDevices& devices,
                       const ArrayXd& grid, double grid_K) {
  MatrixXd all(rows.inputs.cols() * grid.size(),
               static_cast<Index>(devices.size()));
  for (std::size_t k = 0; k < devices.size(); ++k) try {
      all.col(static_cast<Index>(k)) =
          curves_of(rows, devices[k], grid, grid_K);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("device {} of {}: {}", k + 1,
                                              devices.size(), error.what()));
    }
  return all;
}

// Root mean square over the grid of each curve's deviations, one per row.
VectorXd spreads(const MatrixXd& deviations, Index grid) {
  VectorXd spread(deviations.rows());
  for (Index first = 0; first < deviations.rows(); first += grid) {
    const double square =
        deviations.middleRows(first, grid).squaredNorm() / double(grid);
    spread.segment(first, grid)
        .setConstant(square > 0.0 ? std::sqrt(square) : 1.0);
  }
  return spread;
}

// Coefficients are stored to four decimals: they serve statistics over devices.
constexpr double kCoefficientSteps = 1e4;

// Coefficients of kMostCoefficients columns of X, evenly chosen, given the
// eigenvectors and variances of the scaled outer product.
MatrixXd coefficients_of(const MatrixXd& scaled, const MatrixXd& vectors,
                         const VectorXd& variances) {
  const Index devices = scaled.cols();
  const Index kept = std::min(devices, kMostCoefficients);
  MatrixXd c(kept, vectors.cols());
  for (Index k = 0; k < kept; ++k)
    c.row(k) = (vectors.transpose() * scaled.col(k * devices / kept))
                   .cwiseQuotient(variances.cwiseSqrt())
                   .transpose();
  c *= std::sqrt(static_cast<double>(devices - 1));
  return (c.array() * kCoefficientSteps).round() / kCoefficientSteps;
}

// Columns whose outer products add up to X X^T: scaled first, because a
// channel in large units would push the bias below rounding.
void set_modes(Population& p, const MatrixXd& X) {
  const Index grid = p.grid();
  const VectorXd unit = spreads(X, grid);
  const MatrixXd scaled = unit.cwiseInverse().asDiagonal() * X;
  const auto [variance, directions] =
      symmetric_eigen(scaled * scaled.transpose());
  const double least = kLeastVariance * variance.maxCoeff();
  Index kept = 0;
  while (kept < variance.size() && variance(variance.size() - 1 - kept) > least)
    ++kept;
  const MatrixXd vectors = directions.rightCols(kept);
  p.modes = unit.asDiagonal() * vectors *
            variance.tail(kept).cwiseSqrt().asDiagonal();
  p.coefficients = coefficients_of(scaled, vectors, variance.tail(kept));
}

// The rows of a device on legs that fall (`way` -1) or rise (1).
std::vector<Index> rows_of_way(const Eigen::ArrayXi& ways,
                               const std::vector<Index>& own, int way) {
  std::vector<Index> found;
  for (const Index row : own)
    if (ways(row) == way) found.push_back(row);
  return found;
}

// The bias of a device on the grid by rows that reach over it but for a step.
std::optional<ArrayXd> swept_bias(const TrainingRows& rows,
                                  const std::vector<Index>& own,
                                  const ArrayXd& grid, double grid_K) {
  if (own.empty()) return {};
  const ArrayXd T = rows.temperature(own);
  if (T.minCoeff() > grid(0) + grid_K ||
      T.maxCoeff() < grid(grid.size() - 1) - grid_K)
    return {};
  return fit_cubic_spline(T, rows.bias(own), spline_knots(T, grid_K),
                          SplineEnd::kNotAKnot)
      .predict(grid.max(T.minCoeff()).min(T.maxCoeff()));
}

void set_hysteresis(Population& p, const TrainingRows& rows,
                    const RowsOfDevices& devices, double grid_K) {
  const Index kept = p.coefficients.rows();
  if (rows.leg.size() < rows.size()) return;  // not of recordings
  const Eigen::ArrayXi ways = leg_directions(rows);
  MatrixXd half(kept, p.grid());
  for (Index k = 0; k < kept; ++k) {
    const std::vector<Index>& own = devices[static_cast<std::size_t>(
        k * static_cast<Index>(devices.size()) / kept)];
    const auto falling =
        swept_bias(rows, rows_of_way(ways, own, -1), p.temperatures, grid_K);
    const auto rising =
        swept_bias(rows, rows_of_way(ways, own, 1), p.temperatures, grid_K);
    if (!falling || !rising) return;
    half.row(k) = 0.5 * (*falling - *rising).matrix().transpose();
  }
  p.hysteresis = (half.array() * kCoefficientSteps).round() / kCoefficientSteps;
}

// Time between the rows nearest to neighbouring temperatures of the grid, over
// the grid [s]; nothing of rows that leave out an end of it.
std::optional<double> sweep_time(const TrainingRows& rows,
                                 const std::vector<Index>& own,
                                 const ArrayXd& grid) {
  const Index last = grid.size() - 1;
  const double reach = (grid(last) - grid(0)) / static_cast<double>(last);
  const ArrayXd T = rows.temperature(own);
  double sum = 0.0, before = 0.0;
  for (Index g = 0; g <= last; ++g) {
    Index nearest = 0;
    const double distance = (T - grid(g)).abs().minCoeff(&nearest);
    const double now = rows.time(own[static_cast<std::size_t>(nearest)]);
    if ((g == 0 || g == last) && distance > reach) return {};
    if (g > 0) sum += std::abs(now - before);
    before = now;
  }
  return sum;
}

void set_sweeps(Population& p, const TrainingRows& rows,
                const RowsOfDevices& devices) {
  if (rows.run.size() < rows.size() || rows.time.size() < rows.size()) return;
  double count = 0.0, time = 0.0;
  for (const std::vector<Index>& own : devices) {
    std::map<int, std::vector<Index>> runs;
    for (const Index row : own) runs[rows.run(row)].push_back(row);
    for (const auto& [run, of_run] : runs)
      if (const auto found = sweep_time(rows, of_run, p.temperatures)) {
        count += 1.0;
        time += *found;
      }
  }
  const TemperatureRange range = p.range();
  if (time > 0.0)
    p.sweeps = {count / static_cast<double>(devices.size()),
                time / count / (range.highest - range.lowest)};
}

// The prior c ~ N(0, I) above what the points show.
PointEquations with_prior(const PointEquations& points) {
  const Index modes = points.H.cols();
  PointEquations all{MatrixXd(modes + points.H.rows(), modes),
                     VectorXd(modes + points.H.rows())};
  all.H << MatrixXd::Identity(modes, modes), points.H;
  all.y << VectorXd::Zero(modes), points.y;
  return all;
}

double usual_noise(const Population& population, double of_uncompensated) {
  constexpr double kShare = 0.15;
  const MatrixXd bias = population.modes.topRows(population.grid());
  const double square = (bias.rowwise() - bias.colwise().mean()).squaredNorm() /
                        static_cast<double>(population.grid());
  return square > 0.0 ? std::min(of_uncompensated, kShare * std::sqrt(square))
                      : of_uncompensated;
}

}  // namespace

TemperatureRange Population::range() const {
  return {temperatures(0), temperatures(grid() - 1)};
}

Population fit_population(const std::vector<Input>& inputs,
                          const TrainingRows& rows, double grid_K) {
  const RowsOfDevices devices = rows_of_devices(rows);
  const auto count = static_cast<Index>(devices.size());
  if (count < 2)
    throw std::invalid_argument(
        "a population needs recordings of two devices or more; the rows are "
        "of one");
  Population population;
  population.channels.assign(inputs.begin() + 1, inputs.end());
  population.devices = static_cast<int>(count);
  population.temperatures = common_grid(rows, devices, grid_K);
  const MatrixXd curves =
      curves_of_all(rows, devices, population.temperatures, grid_K);
  population.mean = curves.rowwise().mean();
  const MatrixXd deviations = (curves.colwise() - population.mean) /
                              std::sqrt(static_cast<double>(count - 1));
  set_modes(population, deviations);
  set_hysteresis(population, rows, devices, grid_K);
  set_sweeps(population, rows, devices);
  return population;
}

double hysteresis_rms(const Population& population) {
  if (population.hysteresis.size() == 0) return 0.0;
  const double noise = population.point_noise;
  return std::sqrt(std::max(
      4.0 * population.hysteresis.array().square().mean() - 2.0 * noise * noise,
      0.0));
}

MatrixXd true_hysteresis(const Population& population) {
  const MatrixXd& shown = population.hysteresis;
  const double square = shown.size() > 0 ? shown.array().square().mean() : 0.0;
  if (square == 0.0) return shown;
  return shown * (0.5 * hysteresis_rms(population) / std::sqrt(square));
}

LeftOutDevice left_out_device(const Population& population) {
  const auto n = static_cast<double>(population.devices);
  return {(n - 1.0) / (n - 2.0), n / (n - 1.0) / (n - 2.0), n / (n - 1.0)};
}

double curve_spread(const Population& population, Index curve) {
  const Index grid = population.grid();
  return spreads(population.modes.middleRows(curve * grid, grid), grid)(0);
}

double point_noise_of(const Population& population, Index curve,
                      const PointNoise& noise) {
  return curve == 0 ? noise.bias
                    : noise.channel_share * curve_spread(population, curve);
}

double usual_point_noise(const Population& population) {
  return usual_noise(population, PointNoise{}.bias);
}

double usual_run_noise(const Population& population) {
  return usual_noise(population, PointNoise{}.run);
}

double steepest_bias(const Population& population) {
  const Index last = population.grid() - 1;
  const auto rise = [&](const MatrixXd& curves) -> MatrixXd {
    return curves.middleRows(1, last) - curves.topRows(last);
  };
  const ArrayXd square = rise(population.mean).array().square() +
                         rise(population.modes).rowwise().squaredNorm().array();
  const ArrayXd& T = population.temperatures;
  return (square.sqrt() / (T.tail(last) - T.head(last))).maxCoeff();
}

AdaptedBias adapted_bias(const Population& population,
                         const std::vector<Input>& inputs,
                         const TrainingRows& rows, const PointNoise& noise) {
  if (population.modes.cols() == 0)
    return {population.mean.head(population.grid()).array(),
            ArrayXd::Zero(population.grid())};
  const PointEquations all =
      with_prior(point_equations(population, inputs, rows, noise));
  const Index grid = population.grid();
  // A = R^T R of the QR decomposition: its squares are never formed.
  const auto [c, R] = full_rank_solution(all.H, all.y);
  const MatrixXd bias_modes = all_modes(population).topRows(grid);
  const MatrixXd roots = R.transpose().triangularView<Eigen::Lower>().solve(
      bias_modes.transpose());
  const ArrayXd variance = roots.colwise().squaredNorm().transpose().array();
  return {(population.mean.head(grid) + bias_modes * c).array(),
          variance.sqrt()};
}

CubicSpline bias_curve(const Population& population, const ArrayXd& values) {
  return fit_cubic_spline(population.temperatures, values,
                          population.temperatures, SplineEnd::kNotAKnot);
}

}  // namespace beamgyro::internal
