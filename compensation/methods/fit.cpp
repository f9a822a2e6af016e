// SPDX-License-Identifier: MIT
#include "compensation/methods/fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "compensation/methods/method_inputs.h"

namespace beamgyro::internal {
namespace {

constexpr int kBaselineDegree = 3;

}  // namespace

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
  const int degree = std::min(kBaselineDegree, distinct_temperatures(T) - 1);
  const Scale scale =
      degree == 0 ? Scale{T.mean(), 1.0} : scale_to_unit(T, "temperature");
  return {
      {scale},
      {},
      fit_polynomial((T - scale.centre) / scale.half_width, rows.bias, degree)};
}

}  // namespace beamgyro::internal
