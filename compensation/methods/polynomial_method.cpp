// SPDX-License-Identifier: MIT
#include "compensation/methods/polynomial_method.h"

#include <fmt/format.h>

#include "compensation/methods/fit.h"
#include "compensation/methods/input_scales.h"

namespace beamgyro::internal {

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
    return BiasModel{
        scales,
        {},
        fit_polynomial_by_normal_equations(scaled(task.rows.inputs, scales),
                                           task.rows.bias, degree)};
  }
  if (degree == 0 && task.inputs.size() == 1)
    scales[0].centre = temperature.mean();
  else
    scales = scales_of(task);
  return BiasModel{
      scales,
      {},
      fit_polynomial(scaled(task.rows.inputs, scales), task.rows.bias, degree)};
}

}  // namespace beamgyro::internal
