// SPDX-License-Identifier: MIT
#include "sim/dynamics/spurious_bump.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace beamgyro::internal {
namespace {

using Frequency = std::function<double(double T)>;

constexpr double kStep = 5;  // [K]; w_d(T) bends over more than that

// w_s/w_0 - w_d/w_0.
double detuning_at(const SpuriousModeParameters& mode, double reference,
                   double T, double drive_frequency) {
  return 1 + mode.detuning + mode.detuning_tc * (T - kCalibrationTemperature) -
         drive_frequency / reference;
}

SpuriousBump bump_at(const TrimmedGyro& gyro,
                     const SpuriousModeParameters& mode, double T,
                     double drive_tc) {
  return {mode.name, T,
          mode.coupling_drive * mode.coupling_sense * gyro.spurious_reference /
              (2 * mode.loss_factor * gyro.beam.angular_gain),
          mode.loss_factor / std::abs(mode.detuning_tc - drive_tc)};
}

// The zero between two temperatures where the detuning has both signs.
double zero_between(double low, double high,
                    const std::function<double(double T)>& detuning) {
  constexpr double kError = 1e-6;  // [K]
  const bool rises = detuning(low) < 0;
  while (high - low > kError) {
    const double middle = 0.5 * (low + high);
    ((detuning(middle) < 0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<SpuriousBump> spurious_bumps(const TrimmedGyro& gyro, double low,
                                         double high,
                                         const Frequency& drive_frequency) {
  std::vector<SpuriousBump> bumps;
  if (gyro.spurious_reference == 0) return bumps;
  const auto steps =
      std::max(std::size_t{1},
               static_cast<std::size_t>(std::ceil((high - low) / kStep)));
  std::vector<double> temperatures, frequencies;
  for (std::size_t i = 0; i <= steps; ++i) {
    temperatures.push_back(std::lerp(
        low, high, static_cast<double>(i) / static_cast<double>(steps)));
    frequencies.push_back(drive_frequency(temperatures.back()));
  }
  for (const SpuriousModeParameters& mode : gyro.device.spurious_modes) {
    const auto detuning = [&](double T, double w) {
      return detuning_at(mode, gyro.spurious_reference, T, w);
    };
    for (std::size_t i = 0; i < steps; ++i) {
      const double left = temperatures[i], right = temperatures[i + 1];
      if ((detuning(left, frequencies[i]) < 0) ==
          (detuning(right, frequencies[i + 1]) < 0))
        continue;
      const double T = zero_between(left, right, [&](double at) {
        return detuning(at, drive_frequency(at));
      });
      const double a_d = (frequencies[i + 1] - frequencies[i]) /
                         ((right - left) * gyro.spurious_reference);
      bumps.push_back(bump_at(gyro, mode, T, a_d));
    }
  }
  return bumps;
}

std::vector<SpuriousBump> spurious_bumps(const TrimmedGyro& gyro, double low,
                                         double high) {
  if (gyro.spurious_reference == 0) return {};
  const TrimmedGyro without = without_spurious_modes(gyro);
  LockPath path;
  return spurious_bumps(gyro, low, high, [&](double T) {
    return static_solution(without, modal_at(without, T), {}, path)
        .drive_frequency;
  });
}

}  // namespace beamgyro::internal
