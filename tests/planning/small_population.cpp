// SPDX-License-Identifier: MIT
#include "tests/planning/small_population.h"

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "compensation/inputs/input.h"
#include "compensation/rows/training_rows.h"
#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr int kKelvins = 41, kShapes = 4;

// Of bias (curve 0) or channel.
double shape(int number, int curve, double T) {
  const double x = T / 40.0, sign = curve == 0 ? 1.0 : -2.0;
  return sign * std::exp(-2.0 * x * number) *
         std::cos((number + 0.5 * curve) * 3.0 * x);
}

// Every kelvin of each device as rows, from which a population is learned.
TrainingRows rows_of(int devices, bool heavy_tails) {
  TrainingRows rows;
  const Eigen::Index size = Eigen::Index{devices} * kKelvins;
  rows.inputs.setZero(size, 2);
  rows.bias.setZero(size);
  rows.device.resize(size);
  for (int d = 0; d < devices; ++d) {
    RandomStream stream(7, static_cast<std::uint32_t>(d), 0, RandomPurpose{25});
    const double scale = heavy_tails ? (d % 2 == 0 ? 0.3 : 1.7) : 1.0;
    for (int number = 0; number < kShapes; ++number) {
      const double g = scale * stream.normal();
      for (int k = 0; k < kKelvins; ++k) {
        const Eigen::Index row = Eigen::Index{d} * kKelvins + k;
        rows.inputs(row, 0) = k;
        rows.inputs(row, 1) += g * shape(number, 1, k);
        rows.bias(row) += g * shape(number, 0, k);
        rows.device(row) = d;
      }
    }
  }
  rows.temperature = rows.inputs.col(0);
  return rows;
}

}  // namespace

Population small_population(int devices, bool heavy_tails) {
  return fit_population({parse_input("temperature"), parse_input("quadrature")},
                        rows_of(devices, heavy_tails), 1.0);
}

Eigen::ArrayXd same_temperature(const Eigen::ArrayXd& chamber) {
  return chamber;
}

SoakModel model_of(const Population& population, bool bias_only) {
  return {population,
          same_temperature,
          {.range = population.range(), .noise = {}, .bias_only = bias_only}};
}

}  // namespace beamgyro::internal
