// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/method.h"

namespace beamgyro::internal {

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
