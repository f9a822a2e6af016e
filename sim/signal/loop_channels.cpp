// SPDX-License-Identifier: MIT
#include "sim/signal/loop_channels.h"

#include <cstddef>

namespace beamgyro::internal {
namespace {

double value_or_0(std::span<const double> values, std::size_t k) {
  return values.empty() ? 0 : values[k];
}

}  // namespace

std::vector<double> measured_frequency(const LoopChannelParameters& channels,
                                       std::span<const double> frequency,
                                       std::span<const double> noise,
                                       std::span<const double> dT,
                                       std::span<const double> age) {
  std::vector<double> shown(frequency.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double d = dT[k];
    const double y = channels.clock_offset + channels.clock_tc2 * d * d +
                     channels.clock_ageing * (age[k] / kYear);
    shown[k] = frequency[k] * (1 + y) + value_or_0(noise, k);
  }
  return shown;
}

std::vector<double> measured_voltage(const LoopChannelParameters& channels,
                                     std::span<const double> voltage,
                                     std::span<const double> noise,
                                     std::span<const double> dT) {
  std::vector<double> shown(voltage.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double gain =
        1 + channels.voltage_gain_error + channels.voltage_gain_tc * dT[k];
    shown[k] = voltage[k] * gain + value_or_0(noise, k);
  }
  return shown;
}

std::vector<double> measured_quadrature(const LoopChannelParameters& channels,
                                        std::span<const double> quadrature,
                                        std::span<const double> noise,
                                        std::span<const double> dT) {
  std::vector<double> shown(quadrature.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double d = dT[k];
    const double offset =
        channels.quadrature_offset +
        (channels.quadrature_offset_tc + channels.quadrature_offset_tc2 * d) *
            d;
    shown[k] = quadrature[k] + offset + value_or_0(noise, k);
  }
  return shown;
}

}  // namespace beamgyro::internal
