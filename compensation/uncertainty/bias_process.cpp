// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/bias_process.h"

#include <cmath>

namespace beamgyro::internal {

BiasStep bias_step(double before, double after, double temperature_change,
                   double correlation) {
  const double distance = std::abs(temperature_change) / correlation;
  return {std::exp(-distance) * after / before,
          -std::expm1(-2.0 * distance) * after * after};
}

double bias_walk_per_kelvin(double sigma, double correlation) {
  return 2.0 * sigma * sigma / correlation;
}

}  // namespace beamgyro::internal
