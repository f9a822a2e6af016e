// SPDX-License-Identifier: MIT
#include "sim/dynamics/characteristic.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "config/units.h"

namespace beamgyro::internal {
namespace {

void append_row(std::string& csv, const Gyro& gyro, double celsius) {
  const double T = celsius + kZeroCelsius;
  const ModalParameters modal =
      modal_parameters(gyro.device, gyro.beam, T, gyro.stiffness_trim);
  const BeamSignal signal = beam_signal(gyro, modal, {});
  const Electronics electronics = electronics_at(gyro, T);
  const std::complex<double> terms = zero_rate_terms(gyro, modal);
  const double w = signal.drive_frequency;
  const double w_y = std::sqrt(modal.stiffness(1, 1) / modal.mass);
  fmt::format_to(std::back_inserter(csv),
                 "{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},"
                 "{:.12g},{:.12g}\n",
                 celsius, electronics.output(signal.demodulated).rate / kDegree,
                 terms.real() / kDegree, -terms.imag() / kDegree,
                 w / (2 * std::numbers::pi), (w_y - w) / (2 * std::numbers::pi),
                 w * modal.mass / modal.damping(0, 0),
                 w * modal.mass / modal.damping(1, 1), signal.drive_voltage,
                 rate_slope(gyro, modal, T));
}

}  // namespace

std::string characteristic_csv(const Gyro& gyro,
                               std::span<const double> temperatures) {
  std::string csv =
      "temperature_degC,bias_deg_per_s,in_phase_deg_per_s,"
      "quadrature_deg_per_s,drive_frequency_Hz,split_Hz,q_drive,q_sense,"
      "drive_voltage_V,scale_factor_rel\n";
  for (const double celsius : temperatures) append_row(csv, gyro, celsius);
  return csv;
}

}  // namespace beamgyro::internal
