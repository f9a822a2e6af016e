// SPDX-License-Identifier: MIT
#include "sensitivity/figures/static_curve.h"

#include <numbers>

#include "config/units.h"
#include "sim/device/modal_model.h"
#include "sim/dynamics/gyro.h"
#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_ode.h"

namespace beamgyro::internal {
namespace {

double bias_at(const Gyro& gyro, double beam, double board) {
  return electronics_at(gyro, board)
             .output(beam_signal(gyro, beam, {}).demodulated)
             .rate /
         kDegree;
}

NodeVector settled_temperatures(const Gyro& gyro, double ambient) {
  const ThermalNetwork network(gyro.device.thermal);
  const DriveHeating heating = drive_heating(gyro);
  const NodeVector power =
      network.powered_heating(heating.mechanical, heating.dielectric);
  const ThermalSurroundings surroundings{ambient, false};
  const auto& oven = gyro.device.thermal.oven;
  return oven ? oven_steady_state(network, *oven, power, surroundings)
                    .temperature
              : network.steady_state(power, surroundings);
}

}  // namespace

StaticCurve static_curve(const Gyro& gyro, const CurveGrid& grid) {
  StaticCurve curve;
  curve.temperature = grid.temperatures();
  const Eigen::Index count = curve.temperature.size();
  for (Eigen::ArrayXd* column : {&curve.bias, &curve.quadrature,
                                 &curve.drive_frequency, &curve.drive_voltage})
    column->resize(count);
  LockPath path;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double T = curve.temperature(k) + kZeroCelsius;
    const ModalParameters modal = modal_at(gyro, T);
    const BeamSignal signal = beam_signal(gyro, modal, {}, path);
    const Output output = electronics_at(gyro, T).output(signal.demodulated);
    curve.bias(k) = output.rate / kDegree;
    curve.quadrature(k) = output.quadrature / kDegree;
    curve.drive_frequency(k) = signal.drive_frequency / (2 * std::numbers::pi);
    curve.drive_voltage(k) = signal.drive_voltage;
  }
  return curve;
}

Eigen::ArrayXd scale_factor_curve(const Gyro& gyro, const CurveGrid& grid) {
  Eigen::ArrayXd slope = grid.temperatures();
  for (double& value : slope) {
    const double T = value + kZeroCelsius;
    value = rate_slope(gyro, modal_at(gyro, T), T);
  }
  return slope;
}

double warm_up_change(const Gyro& gyro, double ambient) {
  const double T = ambient + kZeroCelsius;
  const NodeVector settled = settled_temperatures(gyro, T);
  return bias_at(gyro, settled(kBeam), settled(kBoard)) - bias_at(gyro, T, T);
}

}  // namespace beamgyro::internal
