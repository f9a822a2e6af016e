// SPDX-License-Identifier: MIT
#include "compensation/methods/bias_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "compensation/methods/method_inputs.h"
#include "compensation/models/bias_function.h"

namespace beamgyro::internal {
namespace {

struct Predict {
  const Eigen::ArrayXXd& x;

  template <class Function>
  Eigen::ArrayXd operator()(const Function& f) const {
    if constexpr (Function::kInputUse == InputUse::kOne)
      return f.predict(x.col(0));
    else
      return f.predict(x);
  }
};

}  // namespace

Scale scale_to_unit(const Eigen::Ref<const Eigen::ArrayXd>& values,
                    const std::string& what) {
  const double low = values.minCoeff(), high = values.maxCoeff();
  if (!(high > low))
    throw UndeterminedFit(
        fmt::format("{} is {} in all {} training rows; the model needs rows "
                    "where it varies",
                    what, low, values.size()));
  return {0.5 * (low + high), 0.5 * (high - low)};
}

Eigen::ArrayXd BiasModel::predict(
    const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  assert(x.cols() == static_cast<Eigen::Index>(input_scales.size()));
  const Eigen::ArrayXXd inputs = scaled(x, input_scales);
  return bias_scale.centre +
         bias_scale.half_width * std::visit(Predict{inputs}, function);
}

BiasModel averaged_with_constant(BiasModel model, double constant,
                                 double weight) {
  assert(weight > 0.0 && weight <= 1.0);
  Scale& scale = model.bias_scale;
  scale = {(1.0 - weight) * constant + weight * scale.centre,
           weight * scale.half_width};
  return model;
}

std::string kind_name(const BiasModel& model) {
  return std::visit([](const auto& f) { return f.kKind; }, model.function);
}

bool reads_inputs(const BiasModel& model) {
  return std::visit(
      [](const auto& f) { return f.kInputUse != InputUse::kNone; },
      model.function);
}

std::vector<double> coefficients_about(const BiasModel& model,
                                       double reference) {
  const auto* polynomial = std::get_if<Polynomial>(&model.function);
  if (polynomial == nullptr)
    throw std::invalid_argument(fmt::format(
        "equation (1) belongs to a polynomial, not to a model of kind {}",
        kind_name(model)));
  if (!polynomial->slopes.empty())
    throw std::invalid_argument(fmt::format(
        "equation (1) has the temperature alone; this polynomial has {} more "
        "inputs",
        polynomial->slopes.size()));
  const Scale scale = model.input_scales.at(0);
  std::vector<double> c = shifted(
      polynomial->coefficients, (reference - scale.centre) / scale.half_width);
  for (std::size_t n = 0; n < c.size(); ++n)
    c[n] *= model.bias_scale.half_width / std::pow(scale.half_width, n);
  c[0] += model.bias_scale.centre;
  return c;
}

EquationOne equation_one(const BiasModel& model) {
  std::vector<double> c = coefficients_about(model, kReferenceTemperature);
  EquationOne result{c[0], {}};
  for (std::size_t n = 1; n < c.size(); ++n)
    result.coefficients.push_back(c[n] / c[0]);
  return result;
}

std::string method_name(const FitSpec& kind) {
  return std::visit([](const auto& spec) { return spec.method_name(); }, kind);
}

double rms_residual(const BiasModel& model, const TrainingRows& rows) {
  return std::sqrt((rows.bias - model.predict(rows.inputs)).square().mean());
}

Fit fit_model(const FitSpec& kind, const std::vector<Input>& inputs,
              const TrainingRows& rows, const TrainingRows& held_out,
              std::uint64_t seed) {
  const FitTask task{inputs, rows, held_out, seed};
  Fit fit = std::visit([&](const auto& spec) { return spec.fit(task); }, kind);
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
  const Eigen::ArrayXd& T = rows.temperature;
  constexpr int kCubic = 3;
  const int degree = std::min(kCubic, distinct_temperatures(T) - 1);
  const Scale scale =
      degree == 0 ? Scale{T.mean(), 1.0} : scale_to_unit(T, "temperature");
  return {
      {scale},
      {},
      fit_polynomial((T - scale.centre) / scale.half_width, rows.bias, degree)};
}

}  // namespace beamgyro::internal
