// SPDX-License-Identifier: MIT
#include "compensation/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compensation/restarts.h"

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr int kBaselineDegree = 3;
// Temperatures closer than this are one temperature to a polynomial, and its
// rows must span this much per degree.
constexpr double kDistinctTemperatures = 1.0;  // [K]

void check_runs(const ModelSpec& spec, const std::vector<TrainingRun>& runs,
                const std::vector<TrainingRun>& held_out) {
  if (runs.empty())
    throw std::invalid_argument("training needs at least one recording");
  if (std::holds_alternative<BpSpec>(spec.kind) && held_out.empty())
    throw std::invalid_argument(
        "a bp network needs held-out recordings to stop early on: pass "
        "--held-out RUN.h5");
  for (const TrainingRun& run : held_out)
    for (const TrainingRun& other : runs)
      if (run.sha256 == other.sha256)
        throw std::invalid_argument(
            fmt::format("{} is held out but equals {}, which is trained on; a "
                        "held-out recording must be another run",
                        run.name, other.name));
}

void check_temperatures(const ArrayXd& temperature, int degree) {
  std::vector<double> sorted(temperature.begin(), temperature.end());
  std::sort(sorted.begin(), sorted.end());
  int distinct = 1;
  double last = sorted.front();
  for (const double T : sorted)
    if (T - last >= kDistinctTemperatures) {
      ++distinct;
      last = T;
    }
  if (distinct < degree + 1)
    throw std::invalid_argument(fmt::format(
        "temperature is between {:.2f} and {:.2f} degC in the training rows, "
        "{} values {} K apart; a polynomial of degree {} needs {}",
        sorted.front(), sorted.back(), distinct, kDistinctTemperatures, degree,
        degree + 1));
}

BiasModel fit(const PolynomialSpec& spec, const ArrayXd& temperature,
              const ArrayXd& bias) {
  check_temperatures(temperature, spec.degree);
  const Scale scale = spec.degree == 0
                          ? Scale{temperature.mean(), 1.0}
                          : scale_to_unit(temperature, "temperature");
  return {{scale},
          {},
          fit_polynomial((temperature - scale.centre) / scale.half_width, bias,
                         spec.degree)};
}

BiasModel fit(const SplineSpec& spec, const ArrayXd& temperature,
              const ArrayXd& bias) {
  const ArrayXd knots = spline_knots(temperature, spec.knot_spacing_K);
  return {{Scale{}}, {}, fit_cubic_spline(temperature, bias, knots, spec.end)};
}

double rms_residual(const BiasModel& model, const ArrayXXd& inputs,
                    const ArrayXd& bias) {
  return std::sqrt((bias - model.predict(inputs)).square().mean());
}

ScaledRows scaled(const TrainingRows& rows, const BiasModel& model) {
  ScaledRows result{rows.inputs, (rows.bias - model.bias_scale.centre) /
                                     model.bias_scale.half_width};
  for (Index i = 0; i < rows.inputs.cols(); ++i) {
    const Scale& scale = model.input_scales[static_cast<std::size_t>(i)];
    result.inputs.col(i) =
        (rows.inputs.col(i) - scale.centre) / scale.half_width;
  }
  return result;
}

// Trains from every set of initial weights; fills the restarts of `result`.
BiasModel fit(const BpSpec& spec, const TrainingRows& rows,
              const TrainingRows& held_out,
              const std::vector<std::string>& names, std::uint64_t seed,
              TrainResult& result) {
  std::vector<int> sizes{static_cast<int>(names.size())};
  sizes.insert(sizes.end(), spec.hidden.begin(), spec.hidden.end());
  sizes.push_back(1);
  BiasModel model{
      {}, scale_to_unit(rows.bias, "rate - true_rate"), BpNetwork(sizes)};
  for (std::size_t i = 0; i < names.size(); ++i)
    model.input_scales.push_back(scale_to_unit(
        rows.inputs.col(static_cast<Index>(i)), "input " + names[i]));

  const double unit = model.bias_scale.half_width;  // [deg/s]
  TrainOptions options = spec.training;
  options.goal = spec.goal_deg_per_s / unit;
  Restarts restarts = train_from_restarts(
      sizes, scaled(rows, model), scaled(held_out, model), options, seed);
  for (TrainSummary& summary : restarts.summaries) {
    summary.in_sample_rms *= unit;
    if (summary.held_out_rms) *summary.held_out_rms *= unit;
  }
  result.restarts = std::move(restarts.summaries);
  result.chosen = restarts.chosen;
  model.function = std::move(restarts.network);
  return model;
}

std::vector<SourceFile> sources(const std::vector<TrainingRun>& runs) {
  std::vector<SourceFile> files;
  files.reserve(runs.size());
  for (const TrainingRun& run : runs) files.push_back({run.name, run.sha256});
  return files;
}

}  // namespace

TrainResult train(const ModelSpec& spec, const std::vector<TrainingRun>& runs,
                  const std::vector<TrainingRun>& held_out,
                  std::uint64_t seed) {
  check_runs(spec, runs, held_out);
  const TrainingRows rows = training_rows(runs, spec.inputs, spec.rows);
  TrainingRows held_out_rows;
  if (!held_out.empty())
    held_out_rows = training_rows(held_out, spec.inputs, spec.rows, rows.range);

  TrainResult result;
  result.rows = rows.size();
  result.held_out_rows = held_out_rows.size();
  Compensator& c = result.compensator;
  c.inputs = spec.inputs;
  c.temperature_range = rows.range;
  c.baseline =
      fit(PolynomialSpec{kBaselineDegree}, rows.temperature, rows.bias);
  if (const auto* bp = std::get_if<BpSpec>(&spec.kind)) {
    c.bias =
        fit(*bp, rows, held_out_rows, input_names(spec.inputs), seed, result);
  } else {
    const ArrayXd T = rows.inputs.col(0);
    if (const auto* spline = std::get_if<SplineSpec>(&spec.kind))
      c.bias = fit(*spline, T, rows.bias);
    else
      c.bias = fit(std::get<PolynomialSpec>(spec.kind), T, rows.bias);
    result.restarts.emplace_back().stop_reason = StopReason::kLeastSquares;
  }

  Provenance& p = c.provenance;
  p.training = sources(runs);
  p.held_out = sources(held_out);
  p.model_text = spec.text;
  p.seed = seed;
  p.in_sample_rms = rms_residual(c.bias, rows.inputs, rows.bias);
  p.baseline_in_sample_rms =
      rms_residual(c.baseline, rows.temperature, rows.bias);
  if (!held_out.empty()) {
    p.held_out_rms =
        rms_residual(c.bias, held_out_rows.inputs, held_out_rows.bias);
    p.baseline_held_out_rms =
        rms_residual(c.baseline, held_out_rows.temperature, held_out_rows.bias);
  }
  TrainSummary& summary = result.restarts[result.chosen];
  summary.in_sample_rms = p.in_sample_rms;
  summary.held_out_rms = p.held_out_rms;
  p.stop_reason = sentence(summary.stop_reason);
  return result;
}

}  // namespace beamgyro
