// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/inputs/features.h"
#include "compensation/inputs/input.h"
#include "compensation/models/lookup_table.h"
#include "compensation/uncertainty/sigma_validity.h"
#include "dataset/files/json_node.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// What the 1-sigma over temperature was computed from.
enum class SigmaSource {
  kPosterior,   // of a Gaussian process: the spread of a population
  kCovariance,  // of a least-squares fit, and the residuals between its groups
  kResiduals,   // of runs, or groups of training rows, that were held out
};

/// A temperature beyond these [degC] is a glitch. Sigma counts it as the nearer
/// one, so that its filters forget it.
constexpr TemperatureRange kSigmaTemperatures = {-273.15, 1000.0};

/// Time constants of the terms of power-on and temperature rate [s].
constexpr double kSigmaTimeConstant = 300.0;

/// A term of the variance that is the square of amplitude times an input.
struct SigmaTerm {
  double amplitude = 0.0;  // [deg/s], or [deg/s/(K/s)] of the temperature rate
  double time_constant = kSigmaTimeConstant;  // [s], > 0

  bool operator==(const SigmaTerm&) const = default;
};

/// How the factor and the amplitudes were calibrated.
struct SigmaCalibration {
  std::string method;      // in words
  std::string by;          // "device", "run", "cycle", ...; "" without groups
  std::size_t groups = 0;  // that the method had
  // Share of the residuals of a further group within half_width times sigma, of
  // conformal prediction [-]; both 0 without.
  double level = 0.0, half_width = 0.0;

  bool operator==(const SigmaCalibration&) const = default;
};

/// 1-sigma of the bias of a compensated rate [deg/s], its standard deviation
/// over devices or runs: the mean square of bias / sigma is 1, whatever the
/// distribution.
///
///   sigma^2 = k^2 {s(T)^2 + (a_on exp(-t / tau_on))^2 + (a_rate r)^2}
///
/// T is the measured temperature, t the time since power-on and r the input
/// temperature_rate(tau_rate) [K/s]. Unlike the inputs of a bias, they are
/// clamped to kSigmaTemperatures only. s(T) has straight lines between the
/// values of `curve`. Beyond them, by d [K], it grows: s^2 = s_end^2 + (growth
/// d)^2.
struct BiasSigma {
  LookupTable curve;               // [deg/s], > 0
  std::array<double, 2> growth{};  // [deg/s/K], > 0, below and above the curve
  std::optional<SigmaTerm> power_on;          // a_on and tau_on
  std::optional<SigmaTerm> temperature_rate;  // a_rate and tau_rate
  double factor = 1.0;                        // k [-], > 0
  SigmaSource source = SigmaSource::kResiduals;
  SigmaCalibration calibration;
  SigmaValidity validity = {};

  /// Returns s(T) [deg/s] without the factor.
  double curve_at(double temperature) const;

  /// Returns sigma [deg/s] at a temperature [degC], exp(-t / tau_on) and a
  /// temperature rate [K/s].
  double at(double temperature, double since_power_on,
            double temperature_rate) const;

  /// Returns the inputs that at() takes, in its order.
  std::vector<Input> inputs() const;
};

/// Computes sigma sample by sample, as firmware would. It starts anew at every
/// power-on, as FeatureStream does.
class BiasSigmaStream {
 public:
  explicit BiasSigmaStream(BiasSigma sigma);

  /// Returns sigma [deg/s] of the sample at `time` [s], NaN for an unpowered
  /// one. Throws std::invalid_argument for a temperature [degC] that is not
  /// finite though the gyro is powered.
  double step(double time, std::uint8_t status, double temperature);

 private:
  BiasSigma sigma_;
  FeatureStream features_;
};

/// Returns sigma [deg/s] of every sample, NaN where unpowered. Throws
/// std::invalid_argument as features_of().
std::vector<double> sigma_of(const BiasSigma& sigma,
                             const Recording& recording);

/// Temperature over which the bias that a compensator leaves forgets itself
/// [K]: its correlation falls to 1/e. It is an assumption, which the metric
/// bias_filter_nis tests.
constexpr double kBiasCorrelation = 10.0;

/// How the bias b [deg/s] that a compensator leaves goes from one time to a
/// later one.
struct BiasStep {
  double carried;   // [-], c
  double variance;  // [(deg/s)^2], of w

  bool operator==(const BiasStep&) const = default;
};

/// Returns the step of a first-order Gauss-Markov process over temperature that
/// has the standard deviations sigma that a compensator states:
///
///   b' = c b + w,  c = rho sigma' / sigma,  var w = (1 - rho^2) sigma'^2,
///   rho = exp(-|dT| / L),                                             (U.1)
///
/// from `before` to `after` [deg/s], over a change dT [K] of the temperature
/// with the correlation L [K]. Then var b' = sigma'^2 if var b = sigma^2.
BiasStep bias_step(double before, double after, double temperature_change,
                   double correlation = kBiasCorrelation);

/// Returns the variance of b' - b of (U.1) per kelvin for small steps, as of a
/// random walk [(deg/s)^2/K]:
///
///   2 sigma^2 / L.                                                    (U.2)
double bias_walk_per_kelvin(double sigma,
                            double correlation = kBiasCorrelation);

/// Put the members `power_on` and `temperature_rate` that are there, and read
/// them. Throw as bias_sigma_json() and read_bias_sigma().
void put_sigma_terms(const std::optional<SigmaTerm>& power_on,
                     const std::optional<SigmaTerm>& temperature_rate,
                     nlohmann::ordered_json& json);
std::optional<SigmaTerm> read_power_on_sigma(const JsonNode& node);
std::optional<SigmaTerm> read_temperature_rate_sigma(const JsonNode& node);

/// Reads the member `half_width`; 0 where it is not there, as in files of older
/// programs. Throws as read_bias_sigma().
double read_half_width(const JsonNode& node);

/// Returns the member `sigma` of a compensator file. Throws std::runtime_error
/// for a number that is not finite.
nlohmann::ordered_json bias_sigma_json(const BiasSigma& sigma);

/// Reads it. Throws std::invalid_argument, naming file and key, for
/// - a key that is missing or not known, or a value of the wrong type;
/// - no temperatures, temperatures that do not increase or lie beyond absolute
///   zero, or another number of sigmas;
/// - a sigma, growth, time constant or factor that is not above 0 and finite,
///   and an amplitude that is below 0;
/// - a half-width below 0;
/// - a source or level that is not one.
BiasSigma read_bias_sigma(const JsonNode& node);

}  // namespace beamgyro::internal
