// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "api/data_sheet.h"
#include "api/design.h"
#include "api/device_figures.h"
#include "config/option_message.h"

namespace beamgyro::internal {

// All lengths by one factor along the beam and one across it. What follows is
// docs/guide/smaller_gyro.md.
void Design::scale_beam(double along, double across) {
  length_factor_ = along;
  side_factor_ = across;
  const auto put = [&](const std::string& key, double factor,
                       const std::string& why) {
    std::vector<double> values = base_.numbers(key);
    if (values.empty()) return;
    for (double& value : values) value *= factor;
    const std::string comment =
        fmt::format("{} x {:.6g}: {}", base_name_, factor, why);
    if (values.size() > 1)
      text_.set(key, values, comment);
    else
      text_.set(key, values[0], comment);
  };
  put("beam.length_m", along, "length");
  put("beam.side_m", across, "side");
  put("patches.length_m", along, "as the length");
  for (const char* key : {"patches.width_m", "patches.thickness_m",
                          "patches.offset_m", "bond.thickness_m"})
    put(key, across, "as the side, else the bias grows");
  put("drive.amplitude_m", along * along / across, "the same strain");
  put("readout.feedthrough_F", along * across, "as the area of a patch");
  const double volume = along * across * across;
  for (const char* node :
       {"beam", "pzt", "mount", "housing", "board", "sensor"})
    put(fmt::format("thermal.{}_heat_capacity_J_per_K", node), volume,
        "as the volume");
  for (const char* joint :
       {"beam_pzt", "beam_mount", "beam_housing", "mount_housing",
        "housing_board", "board_sensor", "housing_sensor", "housing_fixture"})
    put(fmt::format("thermal.{}_conductance_W_per_K", joint),
        across * across / along, "as section over length");
  put("thermal.housing_area_m2", along * across, "as the area");
  put("thermal.housing_height_m", along, "as the length");
  put("thermal.electronics_power_W", across * across / along,
      "as the conductances, for the same rise");
}

// What length and frequency, or side and frequency, make is a beam. Without
// either it is as slender as the base's.
void Design::require_beam(double length, double side) const {
  if ((!sheet_.length && !sheet_.side) || is_beam(length, side)) return;
  const bool stout = length < kStoutest * side;
  throw option_error(
      "{}: with {} the beam would be {} {:g} times as long as thick; expected "
      "a {} frequency",
      NamedOption{"frequency_Hz", fmt::format("{:g}", *sheet_.frequency_Hz)},
      sheet_.length ? fmt::format("a length of {:g} m", *sheet_.length)
                    : fmt::format("a side of {:g} m", *sheet_.side),
      stout ? "less than" : "more than", stout ? kStoutest : kSlenderest,
      stout ? "lower" : "higher");
}

void Design::meet_frequency() {
  const double length = base_.number("beam.length_m");
  const double side = base_.number("beam.side_m");
  double along = 1, across = 1;
  if (sheet_.length) along = *sheet_.length / length;
  if (sheet_.side) across = *sheet_.side / side;
  if (sheet_.length && !sheet_.side) across = along;
  if (sheet_.side && !sheet_.length) along = across;
  scale_beam(along, across);
  if (!sheet_.frequency_Hz) return;
  const double asked = *sheet_.frequency_Hz;
  const double first = steady_figures(device()).frequency;
  if (sheet_.length && sheet_.side) {
    constexpr double kRounding = 0.05;
    if (std::abs(first / asked - 1) > kRounding)
      throw option_error(
          "{}: a beam of {:g} m and {:g} m vibrates at {:.5g} Hz; expected two "
          "of the three, or what they have in common within {:g} %",
          NamedOption{"frequency_Hz", fmt::format("{:g}", asked)},
          *sheet_.length, *sheet_.side, first, 100 * kRounding);
    // The two are rounded: the side takes what is left.
  }
  double found = first;
  for (int k = 0; k < kRounds && std::abs(found / asked - 1) > kSolved; ++k) {
    const double ratio = asked / found;
    if (sheet_.length)
      across *= ratio;  // f ~ a/L^2
    else if (sheet_.side)
      along /= std::sqrt(ratio);
    else
      along /= ratio, across /= ratio;
    require_beam(length * along, side * across);
    scale_beam(along, across);
    found = steady_figures(device()).frequency;
  }
}

// The split is a straight line of the side difference, to which bond and mount
// add a little.
void Design::meet_split() {
  if (!sheet_.split_Hz) return;
  for (int k = 0; k < kRounds; ++k) {
    const double found = steady_figures(device()).split;
    if (std::abs(found / *sheet_.split_Hz - 1) < kSolved) return;
    const double difference = text_.number("beam.side_difference");
    const double frequency = steady_figures(device()).frequency;
    text_.set("beam.side_difference",
              difference - (*sheet_.split_Hz - found) / frequency,
              fmt::format("a split of {:g} Hz", *sheet_.split_Hz));
  }
}

void Design::set_mount() {
  if (sheet_.mount == "metal")
    text_.set("mount.glassy_stiffness_share", 0.0, "wires of metal");
  if (sheet_.mount == "epoxy") {
    text_.set("mount.glass_transition_degC", 60.0,
              "assumed: an epoxy cured at room temperature");
  }
}

void Design::meet_quality() {
  if (sheet_.air_quality)
    text_.set("air.inverse_Q", 1 / *sheet_.air_quality,
              fmt::format("the gas alone leaves {:g}", *sheet_.air_quality));
  if (!sheet_.quality) return;
  const double asked = 1 / *sheet_.quality;
  const auto loss = [&] { return 1 / steady_figures(device()).quality; };
  const double before = loss();
  if (!sheet_.air_quality && asked > before) {
    text_.set("air.inverse_Q", text_.number("air.inverse_Q") + asked - before,
              fmt::format("the gas takes what Q = {:g} needs beside ceramic, "
                          "bond and mount",
                          *sheet_.quality));
    return;
  }
  // The loss of the ceramic adds in proportion.
  const std::string key = "patches.mechanical_loss_factor";
  const double own = text_.number(key);
  if (own == 0)
    throw option_error(
        "{}: the ceramic of {} has no loss to change; expected another base",
        NamedOption{"quality", fmt::format("{:g}", *sheet_.quality)},
        base_name_);
  text_.set(key, 0.0, "");
  const double without = loss();
  const double factor = own * (asked - without) / (before - without);
  if (!(factor >= 0))
    throw option_error(
        "{}: bond, mount, metal and gas alone leave {:.4g}; expected at most "
        "that, or another mount or base",
        NamedOption{"quality", fmt::format("{:g}", *sheet_.quality)},
        1 / without);
  if (!(factor < 0.5))
    throw option_error(
        "{}: beside a gas that leaves {:g} the ceramic would need a loss "
        "factor of {:.3g}; expected a smaller quality factor of the gas",
        NamedOption{"quality", fmt::format("{:g}", *sheet_.quality)},
        1 / text_.number("air.inverse_Q"), factor);
  text_.set(key, factor,
            fmt::format("the ceramic takes what Q = {:g} leaves beside gas, "
                        "bond and mount",
                        *sheet_.quality));
}

}  // namespace beamgyro::internal
