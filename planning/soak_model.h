// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "compensation/inputs/features.h"
#include "compensation/methods/population.h"
#include "compensation/models/cubic_spline.h"

namespace beamgyro::internal {

/// Slow noise of the bias of a device, 1-sigma, as soaks show it.
struct SlowNoise {
  double turn_on = 0.0;  // [deg/s], the same in all soaks
  double walk = 0.0;     // [deg/s/sqrt(s)], from power-on to the soaks
  double own = 0.0;      // [deg/s], of each soak alone
};

/// Returns the symmetric root R of the covariance I - V of what devices of a
/// population really are: c shows them with the slow noise of the sweeps that
/// the population was learned from, and c R has the covariance without it.
///
/// Where the population says how long its sweeps took, V is that of the slow
/// noise `of_sweep` of each: a turn-on offset, a walk along the grid, and noise
/// of each temperature. Negative eigenvalues of I - V, in directions in which
/// the devices differ by less than their noise, count as 0.
///
/// Otherwise V is that of a walk of the bias along the grid, with the largest
/// variance of a step that leaves I - V no negative eigenvalue. The curves of
/// devices are smooth: what is left of their covariance in the directions in
/// which they differ least is noise. Of few devices hardly anything is found in
/// that way. Without such directions, or with fewer modes than values on the
/// grid, nothing is taken off: R = I.
Eigen::MatrixXd truth_root(const Population& population,
                           const std::optional<SlowNoise>& of_sweep = {});

/// Maps temperatures of the chamber [degC] to those that the sensor settles to.
using SensorOfChamber = std::function<Eigen::ArrayXd(const Eigen::ArrayXd&)>;

struct SoakModelOptions {
  TemperatureRange range;  // [degC], of the chamber: where the residual counts
  // Of a soak; without one what the population has learned.
  std::optional<PointNoise> noise = {};
  bool bias_only = false;  // soaks observe no channel of the population
  // Of the devices while the population was learned.
  std::optional<SlowNoise> of_sweep = {};
};

/// Largest distance [K] by which a temperature of the sensor may lie outside
/// those of the population. It takes the value at the end then.
constexpr double kReach = 0.5;

/// What soaks tell about a device of a population, in the coefficients c of its
/// modes: a soak at chamber temperature T observes y = H(T) c + noise of unit
/// variance, one row for the bias and one for each channel. The posterior of c
/// is that of adapted_bias(): covariance A^-1, A = I + sum of H^T H.
class SoakModel {
 public:
  /// Throws std::invalid_argument when the range, seen by the sensor, exceeds
  /// the temperatures of the population by more than kReach.
  SoakModel(Population population, SensorOfChamber sensor,
            const SoakModelOptions& options);

  /// The population, with its own parts as further modes. Its devices have 0
  /// in them, because their curves are sums of the other modes.
  const Population& population() const { return population_; }
  TemperatureRange range() const { return options_.range; }

  /// Returns the same model with the residual over another range. Throws as the
  /// constructor.
  SoakModel over(const TemperatureRange& range) const;
  PointNoise noise() const;
  Eigen::Index modes() const { return population_.modes.cols(); }

  /// Rows that a soak adds to H.
  Eigen::Index rows_per_soak() const;

  /// Returns H: the rows of each soak together, in the order given. Throws as
  /// the constructor for a temperature that the population does not reach.
  Eigen::MatrixXd equations(const std::vector<double>& chamber) const;

  /// What soaks show whose beam lags by `lag` [K] behind the sensor: the rows
  /// `H` of the warmer temperature, and `shift`, by which the mean there
  /// differs from that at the sensor's, over the noise.
  struct Lagging {
    Eigen::MatrixXd H;
    Eigen::VectorXd shift;
  };
  Lagging lagging(const std::vector<double>& chamber,
                  const std::vector<double>& lag) const;

  /// The bias [deg/s] at temperatures of the chamber, of beams that lag
  /// likewise: mean + modes t for a device with coefficients t.
  struct Bias {
    Eigen::VectorXd mean;
    Eigen::MatrixXd modes;
  };
  Bias bias(const std::vector<double>& chamber,
            const std::vector<double>& lag) const;

  /// Returns the rms over devices of the slope of the bias at temperatures of
  /// the chamber [deg/s/K].
  Eigen::VectorXd slope(const std::vector<double>& chamber) const;

  /// Returns true_hysteresis() of the population [deg/s]: a row for each
  /// device, a column for each temperature of the chamber. No columns where it
  /// is not known.
  Eigen::MatrixXd hysteresis(const std::vector<double>& chamber) const;

  /// Returns the mean square of the same over the range, of each device
  /// [(deg/s)^2]. Empty where it is not known.
  const Eigen::VectorXd& hysteresis_square() const {
    return hysteresis_square_;
  }

  /// Returns the temperatures of the chamber [degC] over which the residual is
  /// averaged.
  Eigen::ArrayXd range_grid() const;

  /// Returns whether the population knows the device at this temperature.
  bool reaches(double chamber) const;

  /// W: the mean square over the range of the bias Phi_b e that an error e of c
  /// makes is e^T W e [(deg/s)^2].
  const Eigen::MatrixXd& weight() const { return weight_; }

  /// R: truth_root() of the population.
  const Eigen::MatrixXd& truth() const { return truth_; }

 private:
  void add_own_modes();
  void weigh_range();
  Eigen::ArrayXd known_sensor(const Eigen::ArrayXd& chamber) const;
  Eigen::ArrayXd known_beam(const Eigen::ArrayXd& sensor,
                            const std::vector<double>& lag) const;
  Eigen::MatrixXd values(Eigen::Index curve,
                         const Eigen::ArrayXd& sensor) const;
  Eigen::MatrixXd rows(const Eigen::ArrayXd& sensor) const;

  Population population_;
  SensorOfChamber sensor_;
  SoakModelOptions options_;
  std::vector<double> noise_;  // of a soak, of each curve
  std::vector<CubicSpline>
      modes_;  // of each curve, of the sensor's temperature
  std::vector<CubicSpline> means_;  // likewise
  Eigen::MatrixXd weight_, truth_;
  Eigen::VectorXd hysteresis_square_;
};

}  // namespace beamgyro::internal
