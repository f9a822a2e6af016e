// SPDX-License-Identifier: MIT
#include "compensation/training/cautions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compensation/methods/bias_model.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr double kAtRest = 1.0;  // [deg/s], span of the true rate
constexpr const char* kFeelsTheRate = "feels the rate and training was at rest";

std::string span_caution(const TrainingRows& rows) {
  const double span = rows.range.highest - rows.range.lowest;
  if (span >= kLeastSpan) return "";
  return fmt::format(
      "the temperature spans {:.1f} K in training, less than {:g} K: what is "
      "fitted holds from {:.1f} to {:.1f} degC only",
      span, kLeastSpan, rows.range.lowest, rows.range.highest);
}

std::string gap_caution(const FittedCase& fitted) {
  if (fitted.knows_between) return "";
  const TrainingRows& rows = fitted.rows;
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
  const TemperatureRange& range = fitted.rows.range;
  const auto outside = (held_out.beyond_range > 0.0).count();
  if (outside == 0) return "";
  return fmt::format(
      "{} of {} held-out rows lie outside {:.1f} to {:.1f} degC, the "
      "temperatures seen in training; clamped",
      outside, held_out.size(), range.lowest, range.highest);
}

bool separates_directions(const std::vector<Input>& inputs) {
  return std::any_of(inputs.begin(), inputs.end(), [](const Input& input) {
    return input.kind != InputKind::kColumn || input.column != "temperature";
  });
}

std::string hysteresis_caution(const FittedCase& fitted) {
  if (separates_directions(fitted.inputs)) return "";
  const ArrayXd residual =
      fitted.rows.bias - fitted.model.predict(fitted.rows.inputs);
  const auto found = hysteresis(fitted.rows, residual);
  const double rms = std::sqrt(residual.square().mean());
  if (!found || found->difference <= rms ||
      found->difference <= kSignificance * found->standard_error)
    return "";
  return fmt::format(
      "rising and falling temperature differ by up to {:.3g} deg/s, more than "
      "the residual of {:.3g} deg/s: inputs such as temperature_lowpass(100) "
      "tell them apart",
      found->difference, rms);
}

std::string rate_caution(const FittedCase& fitted) {
  const auto input =
      std::find_if(fitted.inputs.begin(), fitted.inputs.end(), sees_the_rate);
  if (input == fitted.inputs.end() || fitted.rows.true_rate_span > kAtRest)
    return "";
  return fmt::format(
      "the input \"{}\" {}: nothing keeps the model from cancelling the rate; "
      "validate on runs with rate",
      input_name(*input), kFeelsTheRate);
}

std::string ageing_caution(const FittedCase& fitted) {
  const auto reads_frequency = [](const Input& input) {
    return input.column == "drive_frequency";
  };
  if (!fitted.is_ageing || std::ranges::none_of(fitted.inputs, reads_frequency))
    return "";
  return "the input \"drive_frequency\" is no thermometer of a device with "
         "[memory] or [age]: ageing moves it as kelvins do; train without it, "
         "or validate on runs of a later age";
}

struct Cell {
  double sum = 0.0, squares = 0.0, count = 0.0;

  double mean() const { return sum / count; }
  double scatter() const { return squares - sum * sum / count; }
};

constexpr Index kTemperatures = 46, kPlaces = 9;
constexpr double kSmall = 1.0;  // [deg/s]

// [deg/s]: half of what the bias spans over the training rows.
double half_span_of_bias(const FittedCompensator& c) {
  if (c.bias.bias_scale != Scale{}) return c.bias.bias_scale.half_width;
  const TemperatureRange& range = c.temperature_range;
  const ArrayXXd T =
      ArrayXd::LinSpaced(kTemperatures, range.lowest, range.highest);
  const ArrayXd cubic = c.baseline.predict(T);
  return 0.5 * (cubic.maxCoeff() - cubic.minCoeff());
}

// Whether cautions() warned of an input that feels the rate with training at
// rest.
bool warned_of_rate(const std::vector<std::string>& warnings) {
  return std::ranges::any_of(warnings, [](const std::string& warning) {
    return warning.find(kFeelsTheRate) != std::string::npos;
  });
}

// Returns the change of each input with the rate, per deg/s; 0 where it is not
// known.
std::vector<double> slopes_over_rate(const FittedCompensator& c) {
  std::vector<double> slopes(c.inputs.size(), 0.0);
  const bool at_rest = warned_of_rate(c.provenance.warnings);
  for (std::size_t i = 0; i < c.inputs.size(); ++i) {
    if (c.inputs[i].column == "rate") slopes[i] = 1.0;
    if (c.inputs[i].column == "output" && at_rest)
      if (const double span = half_span_of_bias(c); span > 0.0)
        slopes[i] = c.bias.input_scales[i].half_width / span;
  }
  return slopes;
}

// Steady inputs: every temperature with every place of the inputs that see the
// rate between the ends of what they were in training.
ArrayXXd places(const FittedCompensator& c) {
  const TemperatureRange& range = c.temperature_range;
  ArrayXXd x(kTemperatures * kPlaces, static_cast<Index>(c.inputs.size()));
  for (std::size_t i = 0; i < c.inputs.size(); ++i) {
    const Input& input = c.inputs[i];
    const Scale& scale = c.bias.input_scales[i];
    for (Index k = 0; k < x.rows(); ++k) {
      double& value = x(k, static_cast<Index>(i));
      value = 0.0;  // temperature_rate, since_power_on
      if (sees_the_rate(input))
        value =
            scale.centre +
            scale.half_width *
                (2.0 * static_cast<double>(k % kPlaces) / (kPlaces - 1) - 1.0);
      else if (input.column == "temperature" &&
               input.kind != InputKind::kTemperatureRate)
        value =
            range.lowest + (range.highest - range.lowest) *
                               std::floor(static_cast<double>(k) / kPlaces) /
                               (kTemperatures - 1);
      else if (reads_a_signal(input))
        value = scale.centre;
    }
  }
  return x;
}

}  // namespace

std::vector<std::string> cautions(const FittedCase& fitted) {
  std::vector<std::string> found;
  for (std::string& text :
       std::vector{span_caution(fitted.rows), gap_caution(fitted),
                   resolution_caution(fitted), extrapolation_caution(fitted),
                   hysteresis_caution(fitted), rate_caution(fitted),
                   ageing_caution(fitted)})
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

std::optional<Hysteresis> hysteresis(const TrainingRows& rows,
                                     const ArrayXd& residual) {
  std::map<double, Cell> falling, rising;
  const Eigen::ArrayXi direction = leg_directions(rows);
  for (Index k = 0; k < rows.size(); ++k) {
    const int way = direction(k);
    if (way == 0) continue;
    Cell& cell =
        (way > 0 ? rising
                 : falling)[std::floor(rows.temperature(k) / kHysteresisBin)];
    cell.sum += residual(k);
    cell.squares += residual(k) * residual(k);
    cell.count += 1.0;
  }
  double scatter = 0.0, freedom = 0.0;
  for (const auto* cells : {&falling, &rising})
    for (const auto& [bin, cell] : *cells) {
      scatter += std::max(cell.scatter(), 0.0);
      freedom += cell.count - 1.0;
    }
  const double variance =
      freedom > 0.0 ? scatter / freedom : residual.square().mean();
  std::optional<Hysteresis> largest;
  for (const auto& [bin, up] : rising) {
    const auto down = falling.find(bin);
    if (down == falling.end()) continue;
    const double difference = std::abs(up.mean() - down->second.mean());
    if (!largest || difference > largest->difference)
      largest = {difference, std::sqrt(variance * (1.0 / up.count +
                                                   1.0 / down->second.count))};
  }
  return largest;
}

std::string objection_to_claim(const std::optional<GroupErrors>& model,
                               const std::optional<GroupErrors>& constant,
                               double weight) {
  if (!model || !constant)
    return "these scores are on the data that were fitted; they say nothing "
           "about new data: hold out runs, or cross-validate";
  const GroupErrors gain = *constant - *model;
  const double rms = rms_of(*model), plain = rms_of(*constant);
  const std::string figures = fmt::format(
      "no improvement to claim: {:.4g} deg/s rms on unseen data, a constant "
      "{:.4g}",
      rms, plain);
  if (gain.size() < kLeastGroups)
    return fmt::format("{}; fewer than {} groups are no evidence", figures,
                       kLeastGroups);
  if (rms > (1.0 - kUsefulGain) * plain)
    return fmt::format("{}; a useful gain is {:g} %", figures,
                       100.0 * kUsefulGain);
  const double error = standard_error(gain);
  if (gain.mean() > error && weight < 1.0)
    return fmt::format(
        "{}; the groups disagree, which lowers the weight of the model beside "
        "a constant to {:.2f}",
        figures, weight);
  if (gain.mean() > error) return "";
  return fmt::format("{}; the standard error of the difference is {:.2g} deg/s",
                     figures, error / (rms + plain));
}

std::optional<double> rate_kept(const FittedCompensator& c) {
  const std::vector<double> slopes = slopes_over_rate(c);
  if (std::ranges::all_of(slopes, [](double slope) { return slope == 0.0; }))
    return std::nullopt;
  ArrayXXd above = places(c), below = above;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    above.col(static_cast<Index>(i)) += kSmall * slopes[i];
    below.col(static_cast<Index>(i)) -= kSmall * slopes[i];
  }
  return 1.0 - (c.bias.predict(above) - c.bias.predict(below)).mean() /
                   (2.0 * kSmall);
}

}  // namespace beamgyro::internal
