// SPDX-License-Identifier: MIT
#include "compensation/methods/fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compensation/methods/autopilot_fits.h"
#include "compensation/network/restarts.h"

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr int kBaselineDegree = 3;
// Temperatures closer than this are one temperature to a polynomial.
constexpr double kDistinctTemperatures = 1.0;  // [K]

int distinct_temperatures(const ArrayXd& temperature) {
  std::vector<double> sorted(temperature.begin(), temperature.end());
  std::sort(sorted.begin(), sorted.end());
  int distinct = 1;
  double last = sorted.front();
  for (const double T : sorted)
    if (T - last >= kDistinctTemperatures) {
      ++distinct;
      last = T;
    }
  return distinct;
}

void check_temperatures(const ArrayXd& temperature, int degree) {
  const int distinct = distinct_temperatures(temperature);
  if (distinct < degree + 1)
    throw std::invalid_argument(fmt::format(
        "temperature is between {:.2f} and {:.2f} degC in the training rows, "
        "{} values {} K apart; a polynomial of degree {} needs {}",
        temperature.minCoeff(), temperature.maxCoeff(), distinct,
        kDistinctTemperatures, degree, degree + 1));
}

// One for each input, to [-1, 1].
std::vector<Scale> scales_of(const std::vector<Input>& inputs,
                             const TrainingRows& rows) {
  std::vector<Scale> scales;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    scales.push_back(scale_to_unit(rows.inputs.col(static_cast<Index>(i)),
                                   "input " + input_name(inputs[i])));
  return scales;
}

ArrayXXd scaled(const ArrayXXd& inputs, const std::vector<Scale>& scales) {
  ArrayXXd result = inputs;
  for (Index i = 0; i < inputs.cols(); ++i) {
    const Scale& scale = scales[static_cast<std::size_t>(i)];
    result.col(i) = (inputs.col(i) - scale.centre) / scale.half_width;
  }
  return result;
}

ScaledRows scaled(const TrainingRows& rows, const BiasModel& model) {
  return {scaled(rows.inputs, model.input_scales),
          (rows.bias - model.bias_scale.centre) / model.bias_scale.half_width};
}

// Change of the scaled inputs with the rate, in units of the scaled bias.
std::vector<double> rate_direction(const std::vector<Input>& inputs,
                                   const TrainingRows& rows,
                                   const BiasModel& model) {
  std::vector<double> direction(inputs.size(), 0.0);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (sees_the_rate(inputs[i]))
      direction[i] =
          (inputs[i].column == "output" ? rows.output_per_rate : 1.0) *
          model.bias_scale.half_width / model.input_scales[i].half_width;
  return direction;
}

// Fits each kind of model; the restarts stay empty for least squares.
struct Fitter {
  const std::vector<Input>& inputs;
  const TrainingRows& rows;
  const TrainingRows& held_out;
  std::uint64_t seed;
  Fit& fit;

  ArrayXd temperature() const { return rows.inputs.col(0); }
  std::vector<Scale> identity() const {
    return std::vector<Scale>(inputs.size());
  }

  BiasModel operator()(const NoneSpec&) const {
    return {identity(), {}, NoBias{}};
  }

  BiasModel operator()(const ConstantSpec&) const {
    return {identity(), {}, ConstantBias{rows.bias.mean()}};
  }

  BiasModel operator()(const PolynomialSpec& spec) const {
    check_temperatures(temperature(), spec.degree);
    if (!spec.normalised) {
      std::vector<Scale> scales = identity();
      scales[0].centre = kReferenceTemperature;
      return {scales,
              {},
              fit_polynomial_by_normal_equations(scaled(rows.inputs, scales),
                                                 rows.bias, spec.degree)};
    }
    const std::vector<Scale> scales =
        spec.degree == 0 && inputs.size() == 1
            ? std::vector<Scale>{{temperature().mean(), 1.0}}
            : scales_of(inputs, rows);
    return {
        scales,
        {},
        fit_polynomial(scaled(rows.inputs, scales), rows.bias, spec.degree)};
  }

  BiasModel operator()(const TableSpec& spec) const {
    return {identity(),
            {},
            fit_lookup_table(temperature(), rows.bias, spec.bin_width_K)};
  }

  BiasModel operator()(const SplineSpec& spec) const {
    const ArrayXd knots = spline_knots(temperature(), spec.knot_spacing_K);
    return {identity(),
            {},
            fit_cubic_spline(temperature(), rows.bias, knots, spec.end)};
  }

  BiasModel operator()(const Px4Spec&) const { return fit_as_px4(rows); }

  BiasModel operator()(const ArduPilotSpec& spec) const {
    return fit_as_ardupilot(rows, spec.least_samples);
  }

  BiasModel operator()(const ThermistorSpec& spec) const {
    return {identity(),
            {},
            fit_thermistor_network(temperature(), rows.bias, spec.b_K)};
  }

  BiasModel operator()(const FuzzySpec& spec) const {
    const std::vector<Scale> scales = scales_of(inputs, rows);
    return {
        scales,
        {},
        fit_takagi_sugeno(scaled(rows.inputs, scales), rows.bias, spec.rules)};
  }

  BiasModel operator()(const PopulationSpec& spec) const {
    Population p = fit_population(inputs, rows, spec.grid_K);
    fit.choices.push_back(
        fmt::format("{} devices, {} modes on {} temperatures from {:.2f} to "
                    "{:.2f} degC",
                    p.devices, p.modes.cols(), p.grid(), p.range().lowest,
                    p.range().highest));
    BiasModel model{
        identity(), {}, bias_curve(p, p.mean.head(p.grid()).array())};
    fit.population = std::move(p);
    return model;
  }

  BiasModel operator()(const AdaptedSpec& spec) const {
    const AdaptedBias adapted =
        adapted_bias(spec.population, inputs, rows, spec.noise);
    Index worst = 0;
    const double largest = adapted.deviation.maxCoeff(&worst);
    fit.choices.push_back(fmt::format("population: {}", spec.source));
    fit.choices.push_back(fmt::format(
        "1-sigma left open by the rows: rms {:.4f} deg/s, largest {:.4f} deg/s "
        "at {:.1f} degC",
        std::sqrt(adapted.deviation.square().mean()), largest,
        spec.population.temperatures(worst)));
    return {identity(), {}, bias_curve(spec.population, adapted.mean)};
  }

  BiasModel operator()(const BpSpec& spec) const {
    std::vector<int> sizes{static_cast<int>(inputs.size())};
    sizes.insert(sizes.end(), spec.hidden.begin(), spec.hidden.end());
    sizes.push_back(1);
    BiasModel model{scales_of(inputs, rows),
                    scale_to_unit(rows.bias, "rate - true_rate"),
                    BpNetwork(sizes)};
    const double unit = model.bias_scale.half_width;  // [deg/s]
    TrainOptions options = spec.training;
    options.goal = spec.goal_deg_per_s / unit;
    options.rate_direction = rate_direction(inputs, rows, model);
    const ScaledRows training = scaled(rows, model);
    const ScaledRows unseen =
        held_out.size() > 0 ? scaled(held_out, model) : ScaledRows{};
    std::vector<Restarts> of_decays;
    std::vector<BpNetwork> networks;
    for (const double decay : spec.weight_decays) {
      options.weight_decay = decay;
      of_decays.push_back(
          train_from_restarts(sizes, training, unseen, options, seed));
      networks.push_back(of_decays.back().network);
      const TrainSummary& best =
          of_decays.back().summaries[of_decays.back().chosen];
      if (spec.weight_decays.size() > 1)
        fit.choices.push_back(fmt::format(
            "weight decay {:g}: rms in-sample {:.6f}{} deg/s", decay,
            best.in_sample_rms * unit,
            best.held_out_rms
                ? fmt::format(", held-out {:.6f}", *best.held_out_rms * unit)
                : ""));
    }
    const std::size_t kept = best_network(networks, training, unseen, options);
    if (spec.weight_decays.size() > 1)
      fit.choices.push_back(
          fmt::format("kept weight decay {:g}", spec.weight_decays[kept]));
    fit.restarts = std::move(of_decays[kept].summaries);
    fit.chosen = of_decays[kept].chosen;
    model.function = std::move(networks[kept]);
    for (TrainSummary& summary : fit.restarts) {
      summary.in_sample_rms *= unit;
      if (summary.held_out_rms) *summary.held_out_rms *= unit;
    }
    return model;
  }
};

}  // namespace

double rms_residual(const BiasModel& model, const TrainingRows& rows) {
  return std::sqrt((rows.bias - model.predict(rows.inputs)).square().mean());
}

Fit fit_model(const FitSpec& kind, const std::vector<Input>& inputs,
              const TrainingRows& rows, const TrainingRows& held_out,
              std::uint64_t seed) {
  Fit fit;
  fit.model = std::visit(Fitter{inputs, rows, held_out, seed, fit}, kind);
  if (fit.restarts.empty()) {
    TrainSummary& summary = fit.restarts.emplace_back();
    summary.stop_reason = StopReason::kLeastSquares;
    summary.in_sample_rms = rms_residual(fit.model, rows);
    if (held_out.size() > 0)
      summary.held_out_rms = rms_residual(fit.model, held_out);
  }
  return fit;
}

BiasModel fit_baseline(const TrainingRows& rows) {
  const ArrayXd& T = rows.temperature;
  const int degree = std::min(kBaselineDegree, distinct_temperatures(T) - 1);
  const Scale scale =
      degree == 0 ? Scale{T.mean(), 1.0} : scale_to_unit(T, "temperature");
  return {
      {scale},
      {},
      fit_polynomial((T - scale.centre) / scale.half_width, rows.bias, degree)};
}

}  // namespace beamgyro
