// SPDX-License-Identifier: MIT
#include "sim/signal/loop_channels.h"

#include <cstddef>

namespace beamgyro::internal {
namespace {

double value_or_0(std::span<const double> values, std::size_t k) {
  return values.empty() ? 0 : values[k];
}

}  // namespace

double measured_frequency(const LoopChannelParameters& channels,
                          double frequency, double noise, double dT,
                          double age) {
  const double y = channels.clock_offset + channels.clock_tc2 * dT * dT +
                   channels.clock_ageing * (age / kYear);
  return frequency * (1 + y) + noise;
}

double measured_voltage(const LoopChannelParameters& channels, double voltage,
                        double noise, double dT) {
  return voltage *
             (1 + channels.voltage_gain_error + channels.voltage_gain_tc * dT) +
         noise;
}

double measured_quadrature(const LoopChannelParameters& channels,
                           double quadrature, double noise, double dT) {
  const double offset =
      channels.quadrature_offset +
      (channels.quadrature_offset_tc + channels.quadrature_offset_tc2 * dT) *
          dT;
  return quadrature + offset + noise;
}

std::vector<double> measured_frequency(const LoopChannelParameters& channels,
                                       std::span<const double> frequency,
                                       std::span<const double> noise,
                                       std::span<const double> dT,
                                       std::span<const double> age) {
  std::vector<double> shown(frequency.size());
  for (std::size_t k = 0; k < shown.size(); ++k)
    shown[k] = measured_frequency(channels, frequency[k], value_or_0(noise, k),
                                  dT[k], age[k]);
  return shown;
}

std::vector<double> measured_voltage(const LoopChannelParameters& channels,
                                     std::span<const double> voltage,
                                     std::span<const double> noise,
                                     std::span<const double> dT) {
  std::vector<double> shown(voltage.size());
  for (std::size_t k = 0; k < shown.size(); ++k)
    shown[k] =
        measured_voltage(channels, voltage[k], value_or_0(noise, k), dT[k]);
  return shown;
}

std::vector<double> measured_quadrature(const LoopChannelParameters& channels,
                                        std::span<const double> quadrature,
                                        std::span<const double> noise,
                                        std::span<const double> dT) {
  std::vector<double> shown(quadrature.size());
  for (std::size_t k = 0; k < shown.size(); ++k)
    shown[k] = measured_quadrature(channels, quadrature[k],
                                   value_or_0(noise, k), dT[k]);
  return shown;
}

}  // namespace beamgyro::internal
