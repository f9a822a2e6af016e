// SPDX-License-Identifier: MIT
#include "compensation/methods/input_scales.h"

#include <fmt/format.h>

#include <algorithm>

#include "compensation/models/undetermined_fit.h"

namespace beamgyro::internal {
namespace {

// Temperatures closer than this are one temperature to a polynomial.
constexpr double kDistinctTemperatures = 1.0;  // [K]

}  // namespace

int distinct_temperatures(const Eigen::ArrayXd& temperature) {
  std::vector<double> sorted(temperature.begin(), temperature.end());
  std::sort(sorted.begin(), sorted.end());
  int distinct = 1;
  double last = sorted.front();
  for (const double T : sorted)
    if (T - last >= kDistinctTemperatures) {
      ++distinct;
      last = T;
    }
  return distinct;
}

void check_temperatures(const Eigen::ArrayXd& temperature, int degree) {
  const int distinct = distinct_temperatures(temperature);
  if (distinct < degree + 1)
    throw UndeterminedFit(fmt::format(
        "temperature is between {:.2f} and {:.2f} degC in the training rows, "
        "{} values {} K apart; a polynomial of degree {} needs {}",
        temperature.minCoeff(), temperature.maxCoeff(), distinct,
        kDistinctTemperatures, degree, degree + 1));
}

std::vector<Scale> unscaled(const FitTask& task) {
  return std::vector<Scale>(task.inputs.size());
}

std::vector<Scale> scales_of(const FitTask& task) {
  std::vector<Scale> scales;
  for (std::size_t i = 0; i < task.inputs.size(); ++i)
    scales.push_back(
        scale_to_unit(task.rows.inputs.col(static_cast<Eigen::Index>(i)),
                      "input " + input_name(task.inputs[i])));
  return scales;
}

Eigen::ArrayXXd scaled(const Eigen::ArrayXXd& inputs,
                       const std::vector<Scale>& scales) {
  Eigen::ArrayXXd result = inputs;
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) {
    const Scale& scale = scales[static_cast<std::size_t>(i)];
    result.col(i) = (inputs.col(i) - scale.centre) / scale.half_width;
  }
  return result;
}

}  // namespace beamgyro::internal
