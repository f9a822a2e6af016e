// SPDX-License-Identifier: MIT
#include "compensation/training/rate_kept.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "compensation/training/cautions.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

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
      else if (input.kind == InputKind::kColumn)
        value = scale.centre;
    }
  }
  return x;
}

}  // namespace

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
