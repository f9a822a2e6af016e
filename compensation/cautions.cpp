// SPDX-License-Identifier: MIT
#include "compensation/cautions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compensation/fit.h"

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kHysteresisBin = 5.0;  // [K]
constexpr double kAtRest = 1.0;         // [deg/s], span of the true rate

std::string span_caution(const TrainingRows& rows) {
  const double span = rows.range.highest - rows.range.lowest;
  if (span >= kLeastSpan) return "";
  return fmt::format(
      "the temperature spans {:.1f} K in training, less than {:g} K: what is "
      "fitted holds from {:.1f} to {:.1f} degC only",
      span, kLeastSpan, rows.range.lowest, rows.range.highest);
}

std::string gap_caution(const TrainingRows& rows) {
  std::vector<double> sorted(rows.temperature.begin(), rows.temperature.end());
  std::sort(sorted.begin(), sorted.end());
  double widest = 0.0, from = 0.0;
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (sorted[k] - sorted[k - 1] > widest) {
      widest = sorted[k] - sorted[k - 1];
      from = sorted[k - 1];
    }
  if (widest <= kWidestGap) return "";
  return fmt::format(
      "no training row lies between {:.1f} and {:.1f} degC: the bias there is "
      "a guess",
      from, from + widest);
}

// The bias follows the cubic's slope, rms over the rows [deg/s/K].
double bias_slope(const FittedCase& fitted) {
  constexpr double kStep = 0.1;  // [K]
  const ArrayXd& T = fitted.rows.temperature;
  return std::sqrt((fitted.baseline.predict(T + kStep) -
                    fitted.baseline.predict(T - kStep))
                       .square()
                       .mean()) /
         (2.0 * kStep);
}

std::string resolution_caution(const FittedCase& fitted) {
  const double error =
      bias_slope(fitted) * fitted.temperature_resolution / std::sqrt(12.0);
  const double residual = rms_residual(fitted.model, fitted.rows);
  if (!(error > 0.5 * residual)) return "";
  return fmt::format(
      "the temperature comes in steps of {:.3g} K, which alone make {:.3g} "
      "deg/s rms of the in-sample residual of {:.3g} deg/s",
      fitted.temperature_resolution, error, residual);
}

std::string extrapolation_caution(const FittedCase& fitted) {
  const TrainingRows& held_out = fitted.held_out;
  if (held_out.size() == 0) return "";
  // Held-out temperatures come clamped; their samples' range tells.
  const TemperatureRange& range = fitted.rows.range;
  const ArrayXd& T = held_out.temperature;
  const auto outside =
      (T <= range.lowest).count() + (T >= range.highest).count();
  if (outside == 0) return "";
  return fmt::format(
      "{} of {} held-out rows lie outside {:.1f} to {:.1f} degC, the "
      "temperatures seen in training; clamped",
      outside, held_out.size(), range.lowest, range.highest);
}

bool tells_directions_apart(const std::vector<Input>& inputs) {
  return std::any_of(inputs.begin(), inputs.end(), [](const Input& input) {
    return input.kind != InputKind::kColumn || input.column != "temperature";
  });
}

std::string hysteresis_caution(const FittedCase& fitted) {
  if (tells_directions_apart(fitted.inputs)) return "";
  const auto difference = hysteresis(fitted.rows);
  const double residual = rms_residual(fitted.model, fitted.rows);
  if (!difference || *difference <= residual) return "";
  return fmt::format(
      "rising and falling temperature differ by up to {:.3g} deg/s, more than "
      "the residual of {:.3g} deg/s: inputs such as temperature_lowpass(100) "
      "tell them apart",
      *difference, residual);
}

std::string rate_caution(const FittedCase& fitted) {
  const auto input =
      std::find_if(fitted.inputs.begin(), fitted.inputs.end(), sees_the_rate);
  if (input == fitted.inputs.end() || fitted.rows.true_rate_span > kAtRest)
    return "";
  return fmt::format(
      "the input \"{}\" feels the rate and training was at rest: nothing keeps "
      "the model from cancelling the rate; validate on runs with rate",
      input_name(*input));
}

}  // namespace

std::vector<std::string> cautions(const FittedCase& fitted) {
  std::vector<std::string> found;
  for (std::string& text :
       std::vector{span_caution(fitted.rows), gap_caution(fitted.rows),
                   resolution_caution(fitted), extrapolation_caution(fitted),
                   hysteresis_caution(fitted), rate_caution(fitted)})
    if (!text.empty()) found.push_back(std::move(text));
  return found;
}

double temperature_resolution(const Recording& recording) {
  const Column* column = find_column(recording, "temperature");
  if (column == nullptr) return 0.0;
  double smallest = HUGE_VAL;
  for (std::size_t k = 1; k < column->values.size(); ++k) {
    const double step = std::abs(column->values[k] - column->values[k - 1]);
    if (step > 1e-9 && step < smallest) smallest = step;
  }
  return std::isfinite(smallest) ? smallest : 0.0;
}

std::optional<double> hysteresis(const TrainingRows& rows) {
  struct Mean {
    double sum = 0.0, count = 0.0;
  };
  std::map<double, Mean> bins[2];  // falling, rising
  for (Index k = 0; k < rows.size(); ++k) {
    // The direction from the neighbour in the same leg.
    const Index before = k > 0 && rows.leg(k - 1) == rows.leg(k) ? k - 1 : k;
    const Index after =
        k + 1 < rows.size() && rows.leg(k + 1) == rows.leg(k) ? k + 1 : k;
    const double change = rows.temperature(after) - rows.temperature(before);
    if (change == 0.0) continue;
    Mean& mean =
        bins[change > 0.0][std::floor(rows.temperature(k) / kHysteresisBin)];
    mean.sum += rows.bias(k);
    mean.count += 1.0;
  }
  std::optional<double> largest;
  for (const auto& [bin, rising] : bins[1]) {
    const auto falling = bins[0].find(bin);
    if (falling == bins[0].end()) continue;
    const double difference =
        std::abs(rising.sum / rising.count -
                 falling->second.sum / falling->second.count);
    largest = std::max(largest.value_or(0.0), difference);
  }
  return largest;
}

std::string objection_to_claim(const std::optional<GroupErrors>& model,
                               const std::optional<GroupErrors>& constant) {
  if (!model || !constant)
    return "no held-out data: every score here is in-sample and claims nothing";
  const GroupErrors gain = *constant - *model;
  const double error = standard_error(gain);
  if (gain.mean() > error) return "";
  const double rms = rms_of(*model), plain = rms_of(*constant);
  return fmt::format(
      "no improvement to claim: {:.4g} deg/s rms on unseen data, a constant "
      "{:.4g}; the standard error of the difference is {:.2g} deg/s",
      rms, plain, error / (rms + plain));
}

}  // namespace beamgyro
