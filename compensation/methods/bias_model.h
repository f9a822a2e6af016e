// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compensation/methods/method_list.h"

namespace beamgyro::internal {

/// scaled = (value - centre) / half_width
struct Scale {
  double centre = 0.0;
  double half_width = 1.0;  // > 0

  bool operator==(const Scale&) const = default;
};

/// Returns the scale that maps the values to [-1, 1]. Throws
/// std::invalid_argument when they are all equal; `what` names them in the
/// message.
Scale scale_to_unit(const Eigen::Ref<const Eigen::ArrayXd>& values,
                    const std::string& what);

/// Bias predicted from inputs in the units of the recording (degC, V, Hz, ...):
///
///   b = bias.centre + bias.half_width * function(scaled inputs)   [deg/s]
struct BiasModel {
  std::vector<Scale> input_scales;  // one per input
  Scale bias_scale;                 // [deg/s]
  BiasFunction function = {};

  /// One sample per row, one input per column.
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;
};

/// The model of a function that gives the bias itself [deg/s].
inline BiasModel model_of(std::vector<Scale> inputs, BiasFunction function) {
  return {std::move(inputs), {}, std::move(function)};
}

/// Root of the mean square residual [deg/s] over the rows.
double rms_residual(const BiasModel& model, const TrainingRows& rows);

/// Returns the model (1 - weight) constant + weight b, where b is the
/// prediction of `model`: the same function with another bias scale. The weight
/// is above 0: a model of weight 0 is a constant and no scale of a function.
BiasModel averaged_with_constant(BiasModel model, double constant,
                                 double weight);

/// "none", "constant", "polynomial", ...: F::kKind of its function.
std::string kind_name(const BiasModel& model);

/// Whether the bias depends on an input.
bool reads_inputs(const BiasModel& model);

constexpr double kReferenceTemperature = 25.0;  // [degC], T0 of equation (1)

/// Equation (1) at rest: F(T) = F(T0) [1 + a_1 dT + a_2 dT^2 + ...],
/// dT = T - T0.
struct EquationOne {
  double bias_at_reference = 0.0;    // F(T0) [deg/s]
  std::vector<double> coefficients;  // a_n [1/K^n]; not finite if F(T0) = 0
};

/// Returns the coefficients [deg/s/K^n] of the polynomial of `model` in T -
/// `reference`. Throws as equation_one().
std::vector<double> coefficients_about(const BiasModel& model,
                                       double reference);

/// Returns the polynomial of `model` in the form of equation (1). Throws
/// std::invalid_argument when the model is of another kind or has other inputs
/// than the temperature.
EquationOne equation_one(const BiasModel& model);

/// A model fitted to rows.
struct Fit {
  Fit() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): most fits are a model alone
  Fit(BiasModel fitted) : model(std::move(fitted)) {}

  BiasModel model;
  std::vector<TrainSummary> restarts =
      {};                                 // of fit_model() one or more [deg/s]
  std::size_t chosen = 0;                 // the restart kept
  std::vector<std::string> choices = {};  // what was chosen, from what, and why
  std::vector<std::string> warnings = {};  // of what the fit does not support
  std::optional<Population> population = {};  // learned, of a PopulationSpec

  const TrainSummary& summary() const { return restarts[chosen]; }
};

/// Fits `kind` to rows whose input columns are `inputs`. The model of a
/// population is its mean, that of an adapted device the conditional mean; both
/// depend on the temperature alone, the first input. A network stops early on
/// `held_out`, which may be empty; best_network() chooses among its restarts
/// and weight decays. Restart k starts from the stream (seed, 0, k,
/// kInitialWeights). Throws std::invalid_argument when the temperatures are too
/// few or too close together, or an input never varies.
Fit fit_model(const FitSpec& kind, const std::vector<Input>& inputs,
              const TrainingRows& rows, const TrainingRows& held_out,
              std::uint64_t seed);

/// Fits the cubic of equation (1) of the measured temperature; of lower degree
/// where the temperatures do not determine a cubic.
BiasModel fit_baseline(const TrainingRows& rows);

/// Returns the name of a method for people: "cubic spline".
std::string method_name(const FitSpec& kind);

}  // namespace beamgyro::internal
