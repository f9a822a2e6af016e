// SPDX-License-Identifier: MIT
#include "compensation/methods/resonances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/bump_shares.h"
#include "compensation/methods/lines_and_bumps.h"
#include "compensation/methods/method_inputs.h"
#include "compensation/methods/quadrature_fit.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSoakWidth = 5.0;   // [K], see fit_table_at_soaks()
constexpr double kNarrowest = 1.0;   // [K], width of a resonance
constexpr double kWarmUp = 3.0;      // [K], as the electronics heat the beam
constexpr double kWidest = 0.6;      // of the range
constexpr double kRowsNoise = 2e-4;  // [deg/s], of the quadrature of a row

bool is_quadrature(const Input& input) { return input.column == "quadrature"; }

bool tells_of_the_beam(const Input& input) {
  return input.kind == InputKind::kSincePowerOn ||
         is_temperature_lowpass(input);
}

void check_resonance_inputs(const ConfigTable& root,
                            const std::vector<Input>& inputs) {
  const auto wrong = [&](const Input& input, const char* right) {
    root.fail("inputs",
              fmt::format("\"{}\"; resonances take \"temperature\" first, then "
                          "\"temperature_lowpass(TAU)\" and "
                          "\"since_power_on(TAU)\", and \"quadrature\" or "
                          "\"quadrature_lowpass(TAU)\" last: {}",
                          input_name(input), right));
  };
  if (inputs.front() != parse_input("temperature"))
    wrong(inputs.front(), "the first is another");
  if (!is_quadrature(inputs.back()))
    wrong(inputs.back(), "the last is another");
  for (std::size_t j = 1; j + 1 < inputs.size(); ++j)
    if (!tells_of_the_beam(inputs[j]))
      wrong(inputs[j], "it tells nothing of the beam's temperature");
}

// One scale for all temperatures, so that they can be compared.
std::vector<Scale> scales_of_all(const std::vector<Input>& inputs,
                                 const ArrayXXd& all) {
  std::vector<Scale> scales(inputs.size());
  const Scale temperature = scale_to_unit(all.col(0), "input temperature");
  for (std::size_t j = 0; j < inputs.size(); ++j)
    if (inputs[j].column == "temperature") scales[j] = temperature;
  scales.back() = scale_to_unit(all.col(all.cols() - 1),
                                "input " + input_name(inputs.back()));
  return scales;
}

// What the inputs between temperature and quadrature add to the temperature,
// each times its share: how far a low-pass is behind, and what of `warm_up`
// [scaled] is left.
MatrixXd parts_of(const std::vector<Input>& inputs, const ArrayXXd& x,
                  double warm_up) {
  MatrixXd z = x.middleCols(1, x.cols() - 2).matrix();
  for (Index j = 0; j < z.cols(); ++j)
    if (is_temperature_lowpass(inputs[static_cast<std::size_t>(j) + 1]))
      z.col(j) -= x.col(0).matrix();
    else
      z.col(j) *= warm_up;
  return z;
}

// The same as factors of the inputs.
VectorXd position_of(const std::vector<Input>& inputs, const VectorXd& shares,
                     double warm_up) {
  VectorXd position(shares.size() + 1);
  position(0) = 1.0;
  position.tail(shares.size()) = shares;
  for (Index j = 0; j < shares.size(); ++j)
    if (is_temperature_lowpass(inputs[static_cast<std::size_t>(j) + 1]))
      position(0) -= shares(j);
    else
      position(j + 1) *= warm_up;
  return position;
}

// Values at the soaks, over the scaled temperature of the beam.
LookupTable at_soaks(const ArrayXd& beam, const ArrayXd& values,
                     const Scale& scale) {
  LookupTable table = fit_table_at_soaks(scale.centre + scale.half_width * beam,
                                         values, kSoakWidth);
  table.temperatures = (table.temperatures - scale.centre) / scale.half_width;
  return table;
}

// Bumps at scaled temperatures, one column a resonance, as high as its twin.
MatrixXd bumps_of(const ResonanceCurve& curve, const ArrayXd& t) {
  MatrixXd bumps(t.size(), curve.places.size());
  for (Index k = 0; k < bumps.cols(); ++k)
    bumps.col(k) =
        curve.quadrature_heights(k) /
        (1.0 + (2.0 * (t - curve.places(k)) / curve.widths(k)).square());
  return bumps;
}

// Heights and rest of the bias, known at soaks alone. `twin` [deg/s] is that of
// a height of 1 in the quadrature.
ResonanceCurve with_bias_of_soaks(ResonanceCurve curve, const ArrayXd& beam,
                                  const ArrayXd& bias, const Scale& temperature,
                                  double twin) {
  const LookupTable soaks = at_soaks(beam, bias, temperature);
  const double scatter =
      std::sqrt((bias - soaks.predict(beam)).square().mean());
  // Shares are of the twin in units of the bias.
  const VectorXd shares =
      bump_shares(soaks.temperatures.matrix(), soaks.values.matrix(),
                  twin * bumps_of(curve, soaks.temperatures), scatter);
  curve.bias_heights = twin * shares.cwiseProduct(curve.quadrature_heights);
  const ArrayXd left =
      bias - beam.unaryExpr([&](double t) { return curve.bumps_at(t); });
  curve.rest = at_soaks(beam, left, temperature);
  return curve;
}

// The same of the bias of rows at any temperature.
ResonanceCurve with_bias_of_all_rows(ResonanceCurve curve, const ArrayXd& beam,
                                     const ArrayXd& bias,
                                     const Scale& temperature, double twin,
                                     double knot_spacing_K) {
  LinesAndBumps fit =
      fit_lines_and_bumps(beam, bias, twin * bumps_of(curve, beam),
                          knot_spacing_K / temperature.half_width);
  curve.bias_heights = twin * fit.shares.cwiseProduct(curve.quadrature_heights);
  curve.rest = std::move(fit.lines);
  return curve;
}

std::string found_text(const ResonanceCurve& curve, const Scale& temperature,
                       const Scale& quadrature, Index k) {
  const double twin = curve.quadrature_heights(k) * quadrature.half_width;
  return fmt::format(
      "resonance at {:.1f} degC, {:.1f} K wide: twin of {:.4f} deg/s in "
      "quadrature, bump of {:.4f} deg/s in bias",
      temperature.centre + temperature.half_width * curve.places(k),
      temperature.half_width * curve.widths(k), twin, curve.bias_heights(k));
}

}  // namespace

ResonancesSpec ResonancesSpec::read(MethodSource& source) {
  check_resonance_inputs(source.root(), source.inputs);
  const ConfigTable table = source.table(kName);
  ResonancesSpec spec;
  spec.most = static_cast<int>(table.integer_or("most", spec.most, 0, 8));
  spec.degree = static_cast<int>(table.integer_or("degree", spec.degree, 1, 9));
  spec.beam_sigma_K =
      table.number_or("beam_sigma_K", spec.beam_sigma_K, positive());
  spec.quadrature_noise = table.number_or("quadrature_noise_deg_per_s",
                                          spec.quadrature_noise, positive());
  const double spacing =
      table.number_or("knot_spacing_K", 5.0, between(0.5, 50.0));
  if (table.choice_or("entries", "soaks", {"soaks", "knots"}) == "knots")
    spec.knot_spacing_K = spacing;
  return spec;
}

Fit ResonancesSpec::fit(const FitTask& task) const {
  const TrainingRows& rows = task.rows;
  ArrayXXd all(rows.size() + rows.moving.rows(), rows.inputs.cols());
  all.topRows(rows.size()) = rows.inputs;
  if (rows.moving.rows() > 0) all.bottomRows(rows.moving.rows()) = rows.moving;
  const std::vector<Scale> scales = scales_of_all(task.inputs, all);
  const Scale& temperature = scales.front();
  const Scale& quadrature = scales.back();
  const ArrayXXd x = scaled(all, scales);
  const double warm_up = kWarmUp / temperature.half_width;
  const QuadratureFit found =
      fit_quadrature(x.col(0).matrix(), parts_of(task.inputs, x, warm_up),
                     x.col(x.cols() - 1).matrix(),
                     {degree, most, kNarrowest / temperature.half_width,
                      2.0 * kWidest, kRowsNoise / quadrature.half_width});
  ResonanceCurve curve;
  curve.position = position_of(task.inputs, found.shares, warm_up);
  curve.smooth = found.smooth;
  curve.places = found.places;
  curve.widths = found.widths;
  curve.quadrature_heights = found.heights;
  curve.quadrature_sigma =
      std::max(found.rms, quadrature_noise / quadrature.half_width);
  curve.position_sigma = beam_sigma_K / temperature.half_width;

  const ArrayXd beam =
      (x.topLeftCorner(rows.size(), x.cols() - 1).matrix() * curve.position)
          .array();
  curve = knot_spacing_K
              ? with_bias_of_all_rows(curve, beam, rows.bias, temperature,
                                      quadrature.half_width, *knot_spacing_K)
              : with_bias_of_soaks(curve, beam, rows.bias, temperature,
                                   quadrature.half_width);
  std::vector<std::string> choices = {fmt::format(
      "{} resonances, {} rows of quadrature without bias, residual of the "
      "quadrature {:.4f} deg/s rms",
      curve.places.size(), rows.moving.rows(),
      found.rms * quadrature.half_width)};
  for (Index k = 0; k < curve.places.size(); ++k)
    choices.push_back(found_text(curve, temperature, quadrature, k));
  Fit fit = model_of(scales, std::move(curve));
  fit.choices = std::move(choices);
  return fit;
}

}  // namespace beamgyro::internal
