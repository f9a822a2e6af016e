// SPDX-License-Identifier: MIT
#include "compensation/models/resonance_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/firmware/runtime.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;

// Rows {place, 2 / width, bias height, quadrature height} of exported code,
// which needs one.
std::vector<float> pair_rows(const ResonanceCurve& c) {
  std::vector<float> rows;
  for (Index k = 0; k < c.places.size(); ++k)
    for (const double number : {c.places(k), 2.0 / c.widths(k),
                                c.bias_heights(k), c.quadrature_heights(k)})
      rows.push_back(single(number));
  if (rows.empty()) rows = {0.0f, 1.0f, 0.0f, 0.0f};
  return rows;
}

constexpr double kFreedom = 3.0;  // of Student's distribution

// Shift number i, in position_sigma.
double shift_at(int i) {
  return kLargestBeamShift * (2.0 * i / (kBeamShifts - 1) - 1.0);
}

}  // namespace

double ResonanceCurve::bumps_at(double t) const {
  double sum = 0.0;
  for (Index k = 0; k < places.size(); ++k) {
    const double u = 2.0 * (t - places(k)) / widths(k);
    sum += bias_heights(k) / (1.0 + u * u);
  }
  return sum;
}

double ResonanceCurve::quadrature_at(double t) const {
  double value = 0.0;
  for (Index n = smooth.size() - 1; n >= 0; --n) value = value * t + smooth(n);
  for (Index k = 0; k < places.size(); ++k) {
    const double u = 2.0 * (t - places(k)) / widths(k);
    value -= quadrature_heights(k) * u / (1.0 + u * u);
  }
  return value;
}

double ResonanceCurve::beam_at(
    const Eigen::Ref<const Eigen::RowVectorXd>& x) const {
  const double start = x.head(position.size()).dot(position);
  const double q = x(position.size());
  double sum = 0.0, mean = 0.0;
  for (int i = 0; i < kBeamShifts; ++i) {
    const double z = shift_at(i);
    const double shift = z * position_sigma;
    const double r = (q - quadrature_at(start + shift)) / quadrature_sigma;
    const double heavy = 1.0 + r * r / kFreedom;
    const double weight = std::exp(-0.5 * z * z) / (heavy * heavy);
    sum += weight;
    mean += weight * shift;
  }
  return start + mean / sum;
}

Eigen::ArrayXd ResonanceCurve::predict(
    const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  Eigen::ArrayXd bias(x.rows());
  for (Index k = 0; k < x.rows(); ++k) {
    const double t = beam_at(x.row(k).matrix());
    bias(k) = rest.at(t) + bumps_at(t);
  }
  return bias;
}

nlohmann::ordered_json ResonanceCurve::parameters() const {
  return {{"position", numbers_json(position)},
          {"smooth", numbers_json(smooth)},
          {"places", numbers_json(places)},
          {"widths", numbers_json(widths)},
          {"bias_heights_deg_per_s", numbers_json(bias_heights)},
          {"quadrature_heights", numbers_json(quadrature_heights)},
          {"rest_places", numbers_json(rest.temperatures)},
          {"rest_deg_per_s", numbers_json(rest.values)},
          {"quadrature_sigma", finite_json(quadrature_sigma)},
          {"position_sigma", finite_json(position_sigma)}};
}

ResonanceCurve ResonanceCurve::read(const JsonNode& node, std::size_t inputs) {
  constexpr const char* kOfEach = ", one for each of the places";
  ResonanceCurve read;
  if (inputs < 2)
    node.fail(fmt::format(
        "{} inputs, must be the temperature first and the quadrature last",
        inputs));
  read.position =
      read_array(node.at("position"), static_cast<Index>(inputs) - 1,
                 ", one for each input but the last")
          .matrix();
  read.smooth = read_array(node.at("smooth")).matrix();
  if (read.smooth.size() == 0) node.at("smooth").fail("[], must be 1 or more");
  read.places = read_array(node.at("places")).matrix();
  const Index count = read.places.size();
  read.widths = read_array(node.at("widths"), count, kOfEach).matrix();
  if (!(read.widths.array() > 0.0).all())
    node.at("widths").fail("must be above 0");
  read.bias_heights =
      read_array(node.at("bias_heights_deg_per_s"), count, kOfEach).matrix();
  read.quadrature_heights =
      read_array(node.at("quadrature_heights"), count, kOfEach).matrix();
  read.rest = read_lookup_table(node, "rest_deg_per_s", "rest_places");
  read.quadrature_sigma = read_positive(node.at("quadrature_sigma"));
  read.position_sigma = read_positive(node.at("position_sigma"));
  return read;
}

void ResonanceCurve::put_arrays(FirmwareArrays& arrays) const {
  std::vector<double> shifts, priors;
  for (int i = 0; i < kBeamShifts; ++i) {
    const double z = shift_at(i);
    shifts.push_back(z * position_sigma);
    priors.push_back(std::exp(-0.5 * z * z));
  }
  arrays.add({"position", "of the beam, from inputs", singles(position)});
  arrays.add(
      {"quadrature_powers", "powers of the quadrature", singles(smooth)});
  arrays.add({"resonances",
              "place, 2 / width, height of bias and quadrature of each",
              pair_rows(*this)});
  arrays.add({"beam_shifts", "of the beam", singles(shifts)});
  arrays.add({"shift_priors", "of each", singles(priors)});
  arrays.add({"quadrature_gain",
              "1 / (sqrt(3) sigma)",
              {single(1.0 / (std::sqrt(kFreedom) * quadrature_sigma))}});
  arrays.add({"rest_places", "", singles(rest.temperatures)});
  arrays.add({"rest", "[deg/s]", singles(rest.values)});
}

float ResonanceCurve::firmware_value(const FirmwareArrays& arrays,
                                     std::span<const float> x) const {
  float t = 0.0f;
  for (std::size_t j = 0; j + 1 < x.size(); ++j)
    t = t + arrays.data("position")[j] * x[j];
  const int pairs = arrays.count("resonances") / 4;
  t = runtime::beam_place(
      arrays.data("quadrature_powers"), arrays.count("quadrature_powers"),
      arrays.data("resonances"), pairs, arrays.data("beam_shifts"),
      arrays.data("shift_priors"), kBeamShifts,
      arrays.data("quadrature_gain")[0], t, x[x.size() - 1]);
  return runtime::table_at(arrays.data("rest_places"), arrays.data("rest"),
                           arrays.count("rest"), t) +
         runtime::bumps_at(arrays.data("resonances"), pairs, t);
}

FirmwareCode ResonanceCurve::firmware_code(std::size_t inputs) const {
  const std::size_t pairs = pair_rows(*this).size() / 4;
  return {
      {"table", "resonances"},
      fmt::format(
          "  float t = 0.0f;\n"
          "  int j;\n"
          "  for (j = 0; j < {0}; ++j) t = t + position[j] * x[j];\n"
          "  t = beam_place(quadrature_powers, {1}, resonances, {2}, "
          "beam_shifts,\n"
          "                 shift_priors, {3}, quadrature_gain[0], t, "
          "x[{0}]);\n"
          "  return table_at(rest_places, rest, {4}, t) + bumps_at(resonances, "
          "{2}, t);\n",
          inputs - 1, smooth.size(), pairs, kBeamShifts, rest.values.size())};
}

}  // namespace beamgyro::internal
