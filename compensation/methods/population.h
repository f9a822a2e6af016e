// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compensation/inputs/input.h"
#include "compensation/models/cubic_spline.h"
#include "compensation/rows/training_rows.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "compensation/uncertainty/sigma_calibration.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// Calibration of the 1-sigma of devices that are adapted from a population, on
/// devices that it was not learned from.
struct AdaptationSigma {
  double factor = 1.0;                        // [-], of the deviation, > 0
  std::optional<SigmaTerm> power_on;          // as of BiasSigma
  std::optional<SigmaTerm> temperature_rate;  // likewise
  int devices = 0;
  double half_width = 0.0;  // as of SigmaCalibration
};

/// What a device has of its own in a curve, such as spurious resonances at
/// temperatures of its own: a Gaussian process that is independent of all other
/// devices and curves, with Matern's covariance
///
///   s^2 (1 + x) exp(-x),   x = sqrt(3) |T - T'| / L.
struct OwnPart {
  double deviation = 0.0;  // s, in the unit of the curve, >= 0
  double length_K = 1.0;   // L [K], > 0
};

constexpr double kPointWidth = 2.0;  // [K]

/// 1-sigma of a point, which is the mean of rows within kPointWidth of each
/// other. Rows of a soak share slow noise and the turn-on offset, so many are
/// no better than one.
struct PointNoise {
  double bias = 0.03;  // [deg/s], > 0
  // [-], > 0, of a channel: over its spread within the population
  double channel_share = 0.01;
  // [deg/s], > 0, of a whole run: the turn-on offset, and a walk over hours
  // that its points share
  double run = 0.036;
};

/// The sweeps that a population was learned from.
struct Sweeps {
  double of_each_device = 0.0;  // how many cover the grid, mean over devices
  double seconds_per_K = 0.0;   // of a sweep, from one temperature to the next
};

/// The distribution of the gyros of a population. Over devices, the bias b and
/// further channels q_1, q_2, ... (quadrature, ...) as functions of the
/// temperature T are one Gaussian process,
///
///   (b, q_1, ...)(T) = mu(T) + Phi(T) c + r(T),   c ~ N(0, I),
///
/// where r is the own part of a device. mu, each column of Phi, a mode, and r
/// are splines through values on a grid.
struct Population {
  std::vector<Input> channels;  // kColumn each; beside the bias
  Eigen::ArrayXd temperatures;  // [degC], the grid, increasing, at least 4
  // Values on the grid: of the bias [deg/s], then of each channel in its own
  // unit.
  Eigen::VectorXd mean;                    // (1 + channels) * grid
  Eigen::MatrixXd modes;                   // as many rows, one column per mode
  int devices = 0;                         // it was learned from
  std::vector<OwnPart> own = {};           // of each curve; or none has any
  double point_noise = PointNoise{}.bias;  // [deg/s], unless one is given
  double run_noise = PointNoise{}.run;     // likewise
  std::optional<AdaptationSigma> sigma = {};
  // c of its devices, one per row, or of kMostCoefficients of them. Files of
  // older programs have none. The Gaussian process takes no notice of them:
  // they say how far real devices are from it.
  Eigen::MatrixXd coefficients = {};
  // Of the same devices, one per row, on the grid: half of what the bias is
  // more while the temperature falls than while it rises [deg/s]. None unless
  // all devices were swept both ways; the curves are the means of both then.
  Eigen::MatrixXd hysteresis = {};
  // Files of older programs do not say it, nor rows that are of no recordings.
  std::optional<Sweeps> sweeps = {};

  Eigen::Index grid() const { return temperatures.size(); }
  TemperatureRange range() const;
};

constexpr Eigen::Index kMostCoefficients = 1000;

/// Returns the rms over devices and temperatures by which the bias of falling
/// and of rising temperatures differ [deg/s]. The variance of a point's noise
/// in both is taken off. 0 where the devices were not swept both ways.
double hysteresis_rms(const Population& population);

/// Returns Population::hysteresis without that noise: each value is less by the
/// same factor, and the rms is half of hysteresis_rms(). The factor is 1 where
/// the variance of the noise is 0. No values where the devices were not swept
/// both ways.
Eigen::MatrixXd true_hysteresis(const Population& population);

/// How a device of a population, with the coefficients c among n, lies to the
/// n - 1 others: they have the mean -c / (n - 1) and the covariance alpha I -
/// beta c c^T, and the device is gamma c away from their mean:
///
///   alpha = (n - 1) / (n - 2), beta = n / ((n - 1) (n - 2)),
///   gamma = n / (n - 1).
struct LeftOutDevice {
  double alpha, beta, gamma;
};
LeftOutDevice left_out_device(const Population& population);

/// Returns the root mean square over the grid and over devices of a curve's
/// deviation from its mean, in the unit of the curve; 1 if there is none. Curve
/// 0 is the bias, the others are the channels in their order.
double curve_spread(const Population& population, Eigen::Index curve);

/// Returns the 1-sigma of a point of a curve, in the unit of the curve; curve 0
/// is the bias.
double point_noise_of(const Population& population, Eigen::Index curve,
                      const PointNoise& noise);

/// Returns the 1-sigma of a point that is taken where none is given [deg/s]:
/// that of PointNoise, which is that of uncompensated gyros, but no more than
/// 15 % of the rms over devices by which a bias differs from its own mean.
double usual_point_noise(const Population& population);
/// Returns the same of PointNoise::run.
double usual_run_noise(const Population& population);

/// Returns the largest rms over devices of the slope of the bias between two
/// temperatures of the grid [deg/s/K].
double steepest_bias(const Population& population);

/// Learns a population from the rows of two devices or more, whose inputs are
/// the temperature and the channels. The curves of each device are splines
/// through its rows (spline_knots() with a spacing of `grid_K` [K]). They are
/// evaluated on a grid of that spacing or less over the temperatures that all
/// devices have. mu and Phi Phi^T are their mean and sample covariance. Throws
/// std::invalid_argument for
/// - fewer than two devices;
/// - rows of a device that determine no spline;
/// - devices that share less than three steps of the grid.
Population fit_population(const std::vector<Input>& inputs,
                          const TrainingRows& rows, double grid_K);

/// Bias of a device on the grid, given some points of it: conditional mean and
/// 1-sigma.
struct AdaptedBias {
  Eigen::ArrayXd mean;       // [deg/s]
  Eigen::ArrayXd deviation;  // [deg/s], 1-sigma
};

/// Returns the exact conditional E[b | y] of the Gaussian process and its
/// deviation. y are the points of the rows, mu and H the values of the
/// population at them, those of r among them, R their noise:
///
///   c | y ~ N(A^-1 H^T R^-1 (y - mu), A^-1),   A = I + H^T R^-1 H.
///
/// Without rows it is the mean of the population. `inputs` are the columns of
/// the rows: the temperature, then some of the channels of the population.
AdaptedBias adapted_bias(const Population& population,
                         const std::vector<Input>& inputs,
                         const TrainingRows& rows, const PointNoise& noise);

/// Returns the spline through values of the bias [deg/s] on the grid.
CubicSpline bias_curve(const Population& population,
                       const Eigen::ArrayXd& values);

/// Returns the value of the key `population` of a compensator file
/// (docs/reference/compensator_file.md). Throws std::runtime_error for a number
/// that is not finite.
nlohmann::ordered_json population_json(const Population& population);

/// Reads a value that population_json() wrote. Throws as JsonNode.
Population read_population(const JsonNode& node);

/// Returns the rows of devices that the population was not learned from, as
/// residuals of the spline through the soaks of each device itself: what lags
/// on ramps and in warm-ups. `rows` has their temperature, then the channels;
/// the last two columns are since_power_on and temperature_rate. A device whose
/// soaks determine no spline is left out, with a line in `remarks`.
ResidualRows own_curve_residuals(const TrainingRows& rows, double grid_K,
                                 std::vector<std::string>& remarks);

/// Returns the calibration of devices adapted from `population`, on devices it
/// was not learned from. Each is adapted from few soaks of its `soaks`, evenly
/// spaced, and predicted at the others. The factor makes the mean square of
/// what is missed there over k^2 deviation^2 + noise^2 one: a predicted soak
/// has the noise of a point and, of a population that was swept both ways, the
/// quarter of hysteresis_rms()^2 by which each way is off their mean. It is at
/// least 0.5. a_rate and a_on are those of `lagging`, own_curve_residuals(),
/// beyond what soaks leave of the same curves. Without rows to predict,
/// nothing.
std::optional<AdaptationSigma> adaptation_sigma(
    const Population& population, const std::vector<Input>& inputs,
    const TrainingRows& soaks, const ResidualRows& lagging);

/// Returns sigma over temperature of a device adapted with `deviation`, on the
/// grid of the population: k^2 s^2 = k^2 deviation^2 + 2 run_noise^2 +
/// hysteresis_rms()^2 / 2. run_noise [deg/s], PointNoise::run, is that of the
/// run adapted to and, once more, of the run that is compensated, which goes
/// the other way half of the time.
BiasSigma adapted_sigma(const Population& population,
                        const Eigen::ArrayXd& deviation, double run_noise);

/// Returns sigma over temperature of the mean of the population: its spread.
BiasSigma population_sigma(const Population& population);

}  // namespace beamgyro::internal
