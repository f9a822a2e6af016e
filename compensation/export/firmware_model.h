// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/firmware/firmware_arrays.h"

namespace beamgyro::internal {

/// Signals that a compensator can read, in the order and units of firmware
/// samples.
constexpr const char* kFirmwareSignals[] = {
    "rate",       "temperature",     "output",
    "quadrature", "drive_frequency", "drive_voltage"};
constexpr const char* kFirmwareFields[] = {
    "rate_deg_per_s",       "temperature_degC",          "output_V",
    "quadrature_deg_per_s", "drive_frequency_change_Hz", "drive_voltage_V"};
constexpr std::size_t kFirmwareSignalCount = 6;

constexpr std::size_t kFirmwareDriveFrequency = 4;

/// One sample, indexed as kFirmwareSignals. The drive frequency is given as its
/// difference from FirmwareModel::drive_frequency(), because single precision
/// resolves 1 mHz only at 9 kHz.
struct FirmwareSample {
  float value[kFirmwareSignalCount] = {};
};

/// A compensator in single precision, with the constants and the operations of
/// the exported code. Exported code that is compiled without contraction of
/// multiplications and additions gives the same bits.
class FirmwareModel {
 public:
  /// Throws std::invalid_argument for a parameter beyond single precision.
  explicit FirmwareModel(const FittedCompensator& compensator);

  /// Starts at power-on. Samples then come every `period` [s], > 0.
  void start(float period);

  /// Returns the compensated rate [deg/s]. Temperatures out of range are
  /// clamped. An input that is not finite gives NaN; if it is the temperature,
  /// filters wait for the next finite one.
  float step(const FirmwareSample& sample);

  /// Returns the 1-sigma [deg/s] of the bias of the rate that step() returned
  /// last, NaN after a temperature that is not finite. 0 without a sigma.
  float sigma() const;
  bool states_sigma() const { return states_sigma_; }

  const FirmwareArrays& arrays() const { return arrays_; }
  bool reads(std::size_t signal) const;  // index of kFirmwareSignals

  /// Returns the whole number of Hz nearest to the middle of the drive
  /// frequencies of training.
  int drive_frequency() const { return drive_frequency_; }

  /// Returns crc32() of all arrays in their order.
  std::uint32_t crc() const;

 private:
  struct State {
    float period = 0.0f;
    std::uint32_t samples = 0;
    bool started = false;                       // since the first temperature
    std::vector<std::array<float, 5>> filters;  // one per input
    std::vector<float> plays;                   // likewise
    std::array<float, 5> sigma_filter{};
    bool sigma_started = false;
    float sigma = 0.0f;  // [deg/s]
  };

  float next_sigma(float temperature);
  float scale_factor_at(float temperature) const;

  std::vector<Input> inputs_;
  BiasFunction function_;
  bool uses_inputs_;
  bool corrects_scale_factor_;
  bool states_sigma_;
  int drive_frequency_;  // [Hz]
  FirmwareArrays arrays_;
  State state_;
};

/// Returns the CRC-32 (IEEE 802.3) of the values, each with the least
/// significant byte first.
std::uint32_t crc32(const std::vector<float>& values);

}  // namespace beamgyro::internal
