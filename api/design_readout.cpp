// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/data_sheet.h"
#include "api/design.h"
#include "api/device_figures.h"
#include "api/scenario_state.h"
#include "config/units.h"
#include "sim/dynamics/mechanical_noise.h"

namespace beamgyro::internal {
void Design::set_readout() {
  const double scale =
      sheet_.supply_V
          ? *sheet_.supply_V / (2 * base_.number("readout.offset_V"))
          : 1;
  if (sheet_.supply_V) {
    const std::string why = fmt::format("supply of {:g} V", *sheet_.supply_V);
    text_.set("drive.voltage_limit_V", *sheet_.supply_V, why);
    text_.set("readout.offset_V", 0.5 * *sheet_.supply_V, "half of the " + why);
  }
  const double swing = base_.number("readout.scale_factor_V_per_deg_per_s") *
                       base_.number("readout.full_scale_deg_per_s");
  const auto full_scale = full_scale_of(sheet_);
  if (full_scale)
    text_.set("readout.full_scale_deg_per_s", *full_scale,
              sheet_.full_scale_deg_per_s
                  ? "full scale"
                  : "the range, at whose ends it clips");
  if (sheet_.scale_factor_V_per_deg_per_s)
    text_.set("readout.scale_factor_V_per_deg_per_s",
              *sheet_.scale_factor_V_per_deg_per_s, "scale factor");
  else if (full_scale || sheet_.supply_V)
    text_.set("readout.scale_factor_V_per_deg_per_s",
              swing * scale / text_.number("readout.full_scale_deg_per_s"),
              "the full scale is that part of the supply that it is of " +
                  base_name_);
  if (sheet_.adc_bits)
    text_.set("readout.adc_bits", static_cast<double>(*sheet_.adc_bits),
              "of the data sheet");
  if (sheet_.null_deg_per_s)
    text_.set("readout.offset_trim_deg_per_s", *sheet_.null_deg_per_s / 3,
              fmt::format("1 sigma of +-{:g}, taken for 3; a campaign draws it",
                          *sheet_.null_deg_per_s));
  if (sheet_.scale_tolerance_percent)
    text_.set("readout.scale_factor_error",
              *sheet_.scale_tolerance_percent / 300,
              fmt::format("1 sigma of +-{:g} %, taken for 3; a campaign draws "
                          "it",
                          *sheet_.scale_tolerance_percent));
}

// The sense mode answers before the filter, and more the nearer the split is.
void Design::meet_bandwidth(std::vector<std::string>& warnings) {
  if (!sheet_.bandwidth_Hz) return;
  const double asked = *sheet_.bandwidth_Hz;
  const std::string why = fmt::format(
      "corner of each of two poles, for {:g} Hz behind the sense mode", asked);
  text_.set("readout.bandwidth_Hz", asked / kPairOverCorner, why);
  ResponseFigures found;
  for (int k = 0; k < kRounds; ++k) {
    found = response_figures(device());
    if (!found.bandwidth || std::abs(*found.bandwidth / asked - 1) < 5e-3)
      break;
    // Half of the step: a resonance makes the bandwidth jump.
    text_.scale("readout.bandwidth_Hz",
                std::clamp(std::sqrt(asked / *found.bandwidth), 0.7, 1.4), why);
  }
  if (!found.bandwidth || std::abs(*found.bandwidth / asked - 1) >= 0.03)
    text_.set("readout.bandwidth_Hz", asked / kPairOverCorner, why);
  constexpr double kPeak = 1.1;
  if (found.peak > kPeak)
    warnings.push_back(fmt::format(
        "the response peaks at {:.3g} times the rate at {:.3g} Hz, near the "
        "split of the modes; expected a wider split for this bandwidth",
        found.peak, found.peak_frequency));
}

// Mechanics and amplifiers have noise of their own, which grows as the gyro
// shrinks. The rest is the key's.
void Design::meet_noise(std::vector<std::string>& warnings) {
  const auto walk = walk_of(sheet_);
  if (!walk) return;
  const std::string key = "noise.angle_random_walk_deg_per_sqrt_s";
  const std::string amplifier = "readout.amplifier_noise_V_per_sqrt_Hz";
  const auto own_noise = [](const DeviceText& text) {
    return sensing_angle_random_walk(gyro_of(text.device())) / kDegree;
  };
  constexpr double kRate = 10, kNoticed = 0.3;  // [Hz] [-]
  const double step = 2 * text_.number("readout.full_scale_deg_per_s") /
                      std::exp2(text_.number("readout.adc_bits"));
  const double rounding = step / std::sqrt(12 * kRate);
  if (rounding > kNoticed * *walk)
    warnings.push_back(fmt::format(
        "the ADC's steps of {:.2g} deg/s add {:.2g} deg/sqrt(s) to the noise "
        "of {:.4g} at {:g} samples a second; expected more bits",
        step, rounding, *walk, kRate));
  const double square = *walk * *walk;
  double own = own_noise(text_);
  if (own * own > 0.5 * square) {
    DeviceText silent = text_;
    silent.set(amplifier, 0.0, "");
    const double beam = own_noise(silent);
    // Thermal motion of the beam is the less the more it is driven.
    constexpr double kPart = 0.8;  // of the supply
    const double most = kPart * text_.number("drive.voltage_limit_V") /
                        steady_figures(device()).drive_voltage;
    const double more = std::sqrt(3.0) * beam / *walk;
    if (more > 1)
      text_.scale("drive.amplitude_m", std::clamp(most, 1.0, more),
                  fmt::format("driven until its thermal motion is a third of "
                              "the noise, or by {:g} % of the supply",
                              100 * kPart));
    const double left = own_noise(text_);
    const double quiet = beam / std::clamp(most, 1.0, std::max(more, 1.0));
    const double part = (0.6 * square - quiet * quiet) /
                        std::max(left * left - quiet * quiet, 1e-30);
    if (part < 1)
      text_.scale(amplifier, std::sqrt(std::max(part, 0.0)),
                  "of " + base_name_ +
                      ", as far as the noise of the data sheet allows");
    own = own_noise(text_);
  }
  text_.set(key, std::sqrt(std::max(square - own * own, 0.0)),
            fmt::format("of {:.4g} in all, mechanics and amplifier have {:.2g}",
                        *walk, own));
}

void Design::set_noise() {
  constexpr double kFloor = 0.6643;  // least Allan deviation over B
  const auto walk = walk_of(sheet_);
  const double own =
      walk ? output_noise(gyro_of(base_.device())).angle_random_walk / kDegree
           : 0;
  if (own > 0)
    for (const char* other : {"noise.bias_instability_deg_per_s",
                              "noise.rate_random_walk_deg_per_s_per_sqrt_s",
                              "noise.turn_on_deg_per_s"})
      text_.scale(other, *walk / own,
                  "assumed: as the angle random walk, of " + base_name_);
  if (sheet_.instability_deg_per_h)
    text_.set("noise.bias_instability_deg_per_s",
              *sheet_.instability_deg_per_h / 3600 / kFloor,
              fmt::format("{:g} deg/h, the least Allan deviation, over 0.664",
                          *sheet_.instability_deg_per_h));
}

void Design::set_sensor() {
  if (const auto step = resolution_of(sheet_))
    text_.set("temperature_sensor.resolution_K", *step,
              sheet_.bits ? fmt::format("{} bits over {:g} K", *sheet_.bits,
                                        *step * std::exp2(*sheet_.bits))
                          : std::string("of the data sheet"));
  if (sheet_.sensor_tolerance_K)
    text_.set("temperature_sensor.offset_K", *sheet_.sensor_tolerance_K / 3,
              fmt::format("1 sigma of +-{:g} K, taken for 3; a campaign draws "
                          "it",
                          *sheet_.sensor_tolerance_K));
}

void Design::set_supply() {
  if (const auto power = power_of(sheet_))
    text_.set("thermal.electronics_power_W", *power,
              sheet_.power_W
                  ? std::string("of the data sheet")
                  : fmt::format("{:g} A at {:g} V", *sheet_.current_A,
                                *sheet_.supply_V));
}

}  // namespace beamgyro::internal
