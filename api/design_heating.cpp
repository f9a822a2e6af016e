// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "api/data_sheet.h"
#include "api/design.h"
#include "api/device_figures.h"
#include "config/option_message.h"

namespace beamgyro::internal {

// All conductances to the air by one factor, then all heat capacities: the
// rise is the power over the former, the time the latter over the former.
void Design::meet_heating() {
  const bool is_powered = text_.number("thermal.electronics_power_W") > 0;
  for (const auto& [name, value] :
       {std::pair("self_heating_K", sheet_.self_heating_K),
        std::pair("warm_up_s", sheet_.warm_up_s)})
    if (value && !is_powered)
      throw option_error("{}: without power nothing warms; expected {} with it",
                         NamedOption{name, fmt::format("{:g}", *value)},
                         NamedOption{"power_W", "W"});
  if (sheet_.self_heating_K) meet_rise(*sheet_.self_heating_K);
  if (sheet_.warm_up_s) meet_time(*sheet_.warm_up_s);
}

void Design::meet_rise(double rise) {
  const std::string why = fmt::format("for a rise of {:g} K", rise);
  for (int k = 0; k < kRounds; ++k) {
    const double ratio = warm_up_figures(device()).rise / rise;
    if (std::abs(ratio - 1) < 1e-4) return;
    for (const char* key :
         {"housing_board", "board_sensor", "housing_sensor", "housing_fixture"})
      text_.scale(fmt::format("thermal.{}_conductance_W_per_K", key), ratio,
                  why);
    text_.scale("thermal.housing_area_m2", ratio, "to the air, " + why);
  }
}

void Design::meet_time(double time) {
  for (int k = 0; k < kRounds; ++k) {
    const double ratio = time / warm_up_figures(device()).time;
    if (std::abs(ratio - 1) < 1e-3) return;
    for (const char* node :
         {"beam", "pzt", "mount", "housing", "board", "sensor"})
      text_.scale(fmt::format("thermal.{}_heat_capacity_J_per_K", node), ratio,
                  fmt::format("for a warm-up of {:g} s", time));
  }
}

// An amplitude that the supply cannot drive would never lock.
void Design::keep_voltage(std::vector<std::string>& warnings) {
  constexpr double kPart = 0.8;
  const double limit = text_.number("drive.voltage_limit_V");
  const double voltage = steady_figures(device()).drive_voltage;
  if (std::abs(voltage) < limit) return;
  // At the limit the voltage does not tell what is needed.
  for (int k = 0; k < kRounds; ++k) {
    const double now = std::abs(steady_figures(device()).drive_voltage);
    if (now <= kPart * limit * 1.001) break;
    text_.scale("drive.amplitude_m", now >= limit ? 0.5 : kPart * limit / now,
                fmt::format("what {:g} % of the supply drives", 100 * kPart));
  }
  warnings.push_back(fmt::format(
      "the drive amplitude is {:.3g} m: the supply of {:g} V drives no more",
      text_.number("drive.amplitude_m"), limit));
}

}  // namespace beamgyro::internal
