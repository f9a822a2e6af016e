// SPDX-License-Identifier: MIT
#include "compensation/methods/curve_methods.h"

#include <fmt/format.h>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/method_inputs.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {

nlohmann::ordered_json NoBias::parameters() const {
  return nlohmann::ordered_json::object();
}

Eigen::ArrayXd ConstantBias::predict(
    const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  return Eigen::ArrayXd::Constant(x.rows(), value);
}

nlohmann::ordered_json ConstantBias::parameters() const {
  return {{"value_deg_per_s", finite_json(value)}};
}

ConstantBias ConstantBias::read(const JsonNode& node, std::size_t) {
  return {node.at("value_deg_per_s").number()};
}

void ConstantBias::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"constant", "[deg/s]", {single(value)}});
}

Fit NoneSpec::fit(const FitTask& task) const {
  return model_of(unscaled(task), NoBias{});
}

Fit ConstantSpec::fit(const FitTask& task) const {
  return model_of(unscaled(task), ConstantBias{task.rows.bias.mean()});
}

PolynomialSpec PolynomialSpec::read(MethodSource& source) {
  const ConfigTable table = source.table(kName);
  return {static_cast<int>(table.integer_or("degree", 3, 0, 12)),
          table.flag_or("normalised", true)};
}

std::string PolynomialSpec::method_name() const {
  const char* suffix = normalised ? "" : ", not normalised";
  if (degree == 1) return fmt::format("straight line{}", suffix);
  if (degree == 3) return fmt::format("cubic{}", suffix);
  return fmt::format("polynomial of degree {}{}", degree, suffix);
}

Fit PolynomialSpec::fit(const FitTask& task) const {
  const Eigen::ArrayXd temperature = first_input(task);
  check_temperatures(temperature, degree);
  std::vector<Scale> scales = unscaled(task);
  if (!normalised) {
    scales[0].centre = kReferenceTemperature;
    return model_of(
        scales, fit_polynomial_by_normal_equations(
                    scaled(task.rows.inputs, scales), task.rows.bias, degree));
  }
  if (degree == 0 && task.inputs.size() == 1)
    scales[0].centre = temperature.mean();
  else
    scales = scales_of(task);
  return model_of(scales, fit_polynomial(scaled(task.rows.inputs, scales),
                                         task.rows.bias, degree));
}

SplineSpec SplineSpec::read(MethodSource& source) {
  const ConfigTable table = source.table(kName);
  SplineSpec spec;
  spec.knot_spacing_K =
      table.number_or("knot_spacing_K", spec.knot_spacing_K, positive());
  spec.end = table.choice_or("ends", "not_a_knot", {"not_a_knot", "natural"}) ==
                     "natural"
                 ? SplineEnd::kNatural
                 : SplineEnd::kNotAKnot;
  return spec;
}

Fit SplineSpec::fit(const FitTask& task) const {
  const Eigen::ArrayXd temperature = first_input(task);
  return model_of(
      unscaled(task),
      fit_cubic_spline(temperature, task.rows.bias,
                       spline_knots(temperature, knot_spacing_K), end));
}

TableSpec TableSpec::read(MethodSource& source) {
  const ConfigTable table = source.table(kName);
  return {table.number_or("bin_width_K", 5.0, positive()),
          table.choice_or("entries", "bins", {"bins", "soaks"}) == "soaks"};
}

std::string TableSpec::method_name() const {
  return at_soaks ? "straight lines between soaks"
                  : fmt::format("table of {:g} K bins", bin_width_K);
}

Fit TableSpec::fit(const FitTask& task) const {
  const auto fit_table = at_soaks ? fit_table_at_soaks : fit_lookup_table;
  return model_of(unscaled(task),
                  fit_table(first_input(task), task.rows.bias, bin_width_K));
}

ThermistorSpec ThermistorSpec::read(MethodSource& source) {
  return {source.table(kName).number_or("b_K", 3950.0, positive())};
}

Fit ThermistorSpec::fit(const FitTask& task) const {
  return model_of(unscaled(task), fit_thermistor_network(first_input(task),
                                                         task.rows.bias, b_K));
}

FuzzySpec FuzzySpec::read(MethodSource& source) {
  return {
      static_cast<int>(source.table(kName).integer_or("rules", 8, 2, 1000))};
}

std::string FuzzySpec::method_name() const {
  return fmt::format("fuzzy model of {} rules", rules);
}

Fit FuzzySpec::fit(const FitTask& task) const {
  const std::vector<Scale> scales = scales_of(task);
  return model_of(scales, fit_takagi_sugeno(scaled(task.rows.inputs, scales),
                                            task.rows.bias, rules));
}

}  // namespace beamgyro::internal
