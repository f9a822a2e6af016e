// SPDX-License-Identifier: MIT
#include "sim/dynamics/characteristic.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

#include "config/units.h"

namespace beamgyro::internal {
namespace {

constexpr std::array<CharacteristicQuantity, kCharacteristicQuantities>
    kQuantities = {
        {{"bias", "degree/s", "bias_deg_per_s", "output at rate 0"},
         {"in_phase", "degree/s", "in_phase_deg_per_s",
          "input-referred in-phase term"},
         {"quadrature", "degree/s", "quadrature_deg_per_s",
          "input-referred quadrature term"},
         {"drive_frequency", "Hz", "drive_frequency_Hz",
          "frequency of the drive loop"},
         {"split", "Hz", "split_Hz",
          "frequency of the sense mode less the drive frequency"},
         {"q_drive", "1", "q_drive", "quality factor of the drive mode"},
         {"q_sense", "1", "q_sense", "quality factor of the sense mode"},
         {"drive_voltage", "V", "drive_voltage_V",
          "amplitude of the drive voltage"},
         {"scale_factor", "1", "scale_factor_rel",
          "scale factor relative to that at 25 degC"}}};

constexpr std::size_t kBias = 0, kDriveVoltage = 7;  // of kQuantities

CharacteristicRow row_at(const TrimmedGyro& gyro, double celsius) {
  const double T = celsius + kZeroCelsius;
  const ModalParameters modal = modal_at(gyro, T);
  const BeamSignal signal = beam_signal(gyro, modal, {});
  const Electronics electronics = electronics_at(gyro, T);
  const std::complex<double> terms = zero_rate_terms(gyro, modal);
  const double w = signal.drive_frequency;
  const double w_y = std::sqrt(modal.stiffness(1, 1) / modal.mass);
  const Eigen::Matrix2d damping = damping_at(modal, w);
  return {electronics.output(signal.demodulated).rate / kDegree,
          terms.real() / kDegree,
          -terms.imag() / kDegree,
          w / (2 * std::numbers::pi),
          (w_y - w) / (2 * std::numbers::pi),
          w * modal.mass / damping(0, 0),
          w * modal.mass / damping(1, 1),
          signal.drive_voltage,
          rate_slope(gyro, modal, T)};
}

}  // namespace

std::span<const CharacteristicQuantity, kCharacteristicQuantities>
characteristic_quantities() {
  return kQuantities;
}

std::vector<CharacteristicRow> characteristic(
    const TrimmedGyro& gyro, std::span<const double> temperatures) {
  std::vector<CharacteristicRow> rows;
  for (const double celsius : temperatures)
    rows.push_back(row_at(gyro, celsius));
  return rows;
}

CharacteristicLimits limits_met(const DeviceParameters& device,
                                std::span<const CharacteristicRow> rows) {
  CharacteristicLimits limits;
  for (const CharacteristicRow& row : rows) {
    limits.not_locked += row[kDriveVoltage] >= device.drive.voltage_limit;
    limits.saturated +=
        std::abs(row[kBias]) * kDegree >= device.readout.full_scale;
  }
  return limits;
}

std::string characteristic_csv(std::span<const double> temperatures,
                               std::span<const CharacteristicRow> rows) {
  std::string csv = "temperature_degC";
  for (const CharacteristicQuantity& about : kQuantities)
    fmt::format_to(std::back_inserter(csv), ",{}", about.heading);
  csv += '\n';
  for (std::size_t k = 0; k < rows.size(); ++k) {
    fmt::format_to(std::back_inserter(csv), "{}", temperatures[k]);
    for (const double value : rows[k])
      fmt::format_to(std::back_inserter(csv), ",{:.12g}", value);
    csv += '\n';
  }
  return csv;
}

}  // namespace beamgyro::internal
