// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/cubic_spline.h"
#include "compensation/input.h"
#include "compensation/training_rows.h"

namespace beamgyro {

/// What the gyros of a population have in common: over devices the bias b and
/// further channels q_1, q_2, ... (quadrature, ...) of the temperature T are
/// together a Gaussian process,
///
///   (b, q_1, ...)(T) = mu(T) + Phi(T) c,   c ~ N(0, I).
///
/// mu and each column of Phi, a mode, are splines through values on a grid.
struct Population {
  std::vector<Input> channels;  // kColumn each; beside the bias
  Eigen::ArrayXd temperatures;  // [degC], the grid, increasing, at least 4
  // On the grid the bias [deg/s], then each channel in its own unit.
  Eigen::VectorXd mean;   // (1 + channels) * grid
  Eigen::MatrixXd modes;  // as many rows, one column per mode
  int devices = 0;        // it was learned from

  Eigen::Index grid() const { return temperatures.size(); }
  TemperatureRange range() const;
};

/// Learned from rows of two devices or more, the inputs being the temperature
/// and the channels: each device's curves are splines (spline_knots() with a
/// spacing of `grid_K`, [K]) through its rows, taken on a grid of that spacing
/// or less over the temperatures all devices have; mu and Phi Phi^T are their
/// mean and sample covariance. Throws std::invalid_argument for fewer devices,
/// rows of a device that determine no spline, or devices that share less than
/// three steps of the grid.
Population fit_population(const std::vector<Input>& inputs,
                          const TrainingRows& rows, double grid_K);

constexpr double kPointWidth = 2.0;  // [K]

/// 1-sigma of a point, the mean of rows within kPointWidth of each other: rows
/// of a soak share slow noise and the turn-on offset, and many are no better
/// than one.
struct PointNoise {
  double bias = 0.03;  // [deg/s], > 0
  // [-], > 0, of a channel: over its spread within the population
  double channel_share = 0.01;
};

/// What the population knows of the bias of a device once points of it are
/// known, on the grid.
struct AdaptedBias {
  Eigen::ArrayXd mean;       // [deg/s]
  Eigen::ArrayXd deviation;  // [deg/s], 1-sigma
};

/// The exact conditional of the Gaussian: E[b | y] and its deviation, y being
/// the points of the rows, mu and H theirs of the population, R the noise,
///
///   c | y ~ N(A^-1 H^T R^-1 (y - mu), A^-1),   A = I + H^T R^-1 H.
///
/// Without rows it is the population's own. `inputs` are the columns of the
/// rows: the temperature, then some of the population's channels.
AdaptedBias adapted_bias(const Population& population,
                         const std::vector<Input>& inputs,
                         const TrainingRows& rows, const PointNoise& noise);

/// The spline through values of the bias [deg/s] on the grid.
CubicSpline bias_curve(const Population& population,
                       const Eigen::ArrayXd& values);

}  // namespace beamgyro
