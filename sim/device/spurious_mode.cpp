// SPDX-License-Identifier: MIT
#include "sim/device/spurious_mode.h"

#include <cmath>

#include "sim/device/materials.h"

namespace beamgyro::internal {

std::vector<SpuriousResonance> spurious_resonances(
    std::span<const SpuriousModeParameters> modes, double reference,
    double mass, const SpuriousTemperatures& temperatures,
    const MemoryState& memory) {
  const double strength = reference * reference * std::sqrt(mass);
  std::vector<SpuriousResonance> resonances;
  resonances.reserve(modes.size());
  for (const SpuriousModeParameters& mode : modes) {
    const double T =
        mode.follows_housing ? temperatures.housing : temperatures.beam;
    const double detuning = mode.detuning + mode.drift * memory.decades +
                            mode.slip * memory.hysteresis;
    const double w_s =
        reference *
        (1 + detuning + mode.detuning_tc * (T - kCalibrationTemperature));
    resonances.push_back(
        {.square = w_s * w_s,
         .width = mode.loss_factor * w_s,
         .coupling = strength * Eigen::Vector2d(mode.coupling_drive,
                                                mode.coupling_sense)});
  }
  return resonances;
}

SpuriousStiffness spurious_stiffness(std::span<const SpuriousResonance> modes,
                                     double omega) {
  SpuriousStiffness sum{Eigen::Matrix2cd::Zero(), Eigen::Matrix2cd::Zero()};
  for (const SpuriousResonance& mode : modes) {
    const Complex denominator(mode.square - omega * omega, mode.width * omega);
    const Complex response =
        std::conj(denominator) / std::norm(denominator);  // 1/denominator
    const Complex slope = Complex(-2 * omega, mode.width) * response * response;
    const double xx = mode.coupling(0) * mode.coupling(0);
    const double xy = mode.coupling(0) * mode.coupling(1);
    const double yy = mode.coupling(1) * mode.coupling(1);
    sum.value(0, 0) -= xx * response;
    sum.value(0, 1) -= xy * response;
    sum.value(1, 1) -= yy * response;
    sum.slope(0, 0) += xx * slope;
    sum.slope(0, 1) += xy * slope;
    sum.slope(1, 1) += yy * slope;
  }
  sum.value(1, 0) = sum.value(0, 1);
  sum.slope(1, 0) = sum.slope(0, 1);
  return sum;
}

}  // namespace beamgyro::internal
