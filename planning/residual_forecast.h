// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "planning/chamber.h"
#include "planning/soak_model.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {

/// Returns L, so that L z with normal numbers z are the errors [deg/s] of these
/// soaks, a row for each in the order given, and with `start_row` of a row
/// right after power-on behind them.
Eigen::MatrixXd slow_noise_root(const SlowNoise& noise,
                                const std::vector<double>& soaks,
                                const ChamberTime& time,
                                bool start_row = false);

/// Adds independent errors of the soaks, 1-sigma [deg/s], to a
/// slow_noise_root(), such as those of a bias that is read at another
/// temperature.
void add_noise(const Eigen::VectorXd& of_soaks, Eigen::MatrixXd& root);

/// The 95 % intervals of the quantiles of a forecast.
struct ForecastIntervals {
  Interval median, p90, p95;
};

constexpr std::array<double, 3> kForecastShares = {0.5, 0.9, 0.95};

/// The rms over the range [deg/s] of what compensation leaves of the bias: its
/// quantiles over devices of the population.
struct ResidualForecast {
  double median = 0.0, p90 = 0.0, p95 = 0.0;
  // Where they were computed, forecast_with_intervals().
  std::optional<ForecastIntervals> intervals = {};
};

/// Where a forecast takes its devices from.
enum class ForecastBasis {
  kDevices,   // each device of the population, predicted by all others
  kGaussian,  // draws from the Gaussian process
};

/// How the soaks of a real device differ from what they are taken for.
struct SoakErrors {
  // [K], of each soak: by how much the beam is warmer than the sensor says.
  // Empty: not at all.
  std::vector<double> lag;
  // L: the bias of the soaks is wrong by L z [deg/s], z ~ N(0, I), and channels
  // are exact. Empty: all rows have the independent noise of
  // SoakModel::noise().
  Eigen::MatrixXd noise;
  // Of each soak: 1 where the chamber was warmer before, -1 where it was
  // colder. Empty: hysteresis is left out.
  std::vector<double> way = {};
};

/// The basis that a population allows: its devices if it stores the
/// coefficients of three or more.
ForecastBasis forecast_basis(const Population& population);

/// Forecasts the residual of devices that are adapted from soaks at these
/// temperatures of the chamber, as adapted_bias() does it.
///
/// Of devices: device d with coefficients c among n is predicted from the
/// other n - 1. In the coordinates of c these have the mean -c / (n - 1) and
/// the covariance
///
///   P_d = ((n - 1) I - n / (n - 1) c c^T) / (n - 2),
///
/// the device is x = n / (n - 1) R c without the noise of its training
/// (SoakModel::truth()), the soaks show G x + shift + noise
/// (SoakModel::lagging()), and the residual is that of
/// e = x - P_d H^T (H P_d H^T + I)^-1 (G x + shift + noise).
///
/// With the hysteresis h of the devices, soaks show h more on a way down and
/// less on a way up, and the mean square of the residual is that over both ways
/// of the run that is compensated: h^2 is added to that of e.
///
/// Of the Gaussian process: x is drawn from N(0, R^2), and mean and covariance
/// are known.
///
/// Noise and x come from counter-based streams: the forecast of the same soaks
/// is always the same.
ResidualForecast forecast_residual(const SoakModel& model,
                                   const std::vector<double>& soaks,
                                   const SoakErrors& errors = {});

/// The rms over the range [deg/s] that is left of each device of a population
/// in each draw of the noise: device d in round r at r devices + d.
struct ResidualDraws {
  std::size_t devices = 0;
  std::vector<double> rms;
};

ResidualForecast forecast_of(const ResidualDraws& draws);

/// Devices of a population, given as its draws are: every `folds`-th from
/// `first` on.
struct Fold {
  std::size_t first = 0, folds = 1;
};

/// Returns a root of the covariance of the coefficients of all devices but
/// those of a fold, with that of own parts.
Eigen::MatrixXd root_without(const SoakModel& model, const Fold& fold);

/// Puts the draws of the devices of a fold in place of those in `all`.
void take_fold(const ResidualDraws& of_fold, const Fold& fold,
               ResidualDraws& all);

/// Returns the draws behind forecast_residual(). The population must allow
/// ForecastBasis::kDevices.
ResidualDraws residual_draws(const SoakModel& model,
                             const std::vector<double>& soaks,
                             const SoakErrors& errors = {});

/// Returns the same of straight lines between the soaks, level beyond them,
/// which take nothing from the population: its devices are only what they are
/// tried on. One soak is a constant.
ResidualDraws straight_line_draws(const SoakModel& model,
                                  const std::vector<double>& soaks,
                                  const SoakErrors& errors = {});

}  // namespace beamgyro::internal
