// SPDX-License-Identifier: MIT
#include "include/beamgyro/device_design.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "api/data_sheet.h"
#include "api/design.h"
#include "api/device_figures.h"

namespace beamgyro {
namespace internal {
namespace {

std::string origin_of(const Device& base) {
  return "as " + std::filesystem::path(base.name()).filename().string();
}

}  // namespace

Design::Design(const Device& base, const DataSheet& sheet)
    : sheet_(sheet),
      base_name_(std::filesystem::path(base.name()).filename().string()),
      base_(base.text(), base.name(), origin_of(base)),
      text_(base_) {
  heading_ = {"A gyro from these figures of a data sheet:"};
  for (const std::string& figure : figures_of(sheet))
    heading_.push_back("  " + figure);
  heading_.push_back("What none of them says is scaled from " + base_name_ +
                     " or kept; see the comment of each key.");
}

void Design::add_figures(const Device& made, DesignedDevice& result) {
  const auto add = [&](const char* name, const char* unit,
                       std::optional<double> asked, double tolerance,
                       const std::function<std::optional<double>()>& measured) {
    if (!asked) return;
    result.figures.push_back(
        {name, unit, *asked, measured().value_or(NAN), tolerance});
    const DesignFigure& figure = result.figures.back();
    if (!figure.is_met())
      result.warnings.push_back(
          std::isnan(figure.measured)
              ? fmt::format("{}: {:g} {} asked for, and no run shows one", name,
                            figure.asked, unit)
              : fmt::format("{}: {:.6g} {} asked for, the device has {:.6g}: "
                            "{:+.2g} %",
                            name, figure.asked, unit, figure.measured,
                            100 * (figure.measured / figure.asked - 1)));
  };
  const SteadyFigures steady = steady_figures(made);
  add("drive frequency", "Hz", sheet_.frequency_Hz, 1e-3,
      [&] { return steady.frequency; });
  add("split", "Hz", sheet_.split_Hz, 1e-2, [&] { return steady.split; });
  add("quality factor", "", sheet_.quality, 1e-2,
      [&] { return steady.quality; });
  // An hour gives N within some percent.
  add("angle random walk", "deg/sqrt(s)", walk_of(sheet_), 0.05,
      [&] { return noise_figure(made); });
  add("bandwidth", "Hz", sheet_.bandwidth_Hz, 0.03,
      [&] { return response_figures(made).bandwidth; });
  add("self-heating", "K", sheet_.self_heating_K, 1e-2,
      [&] { return warm_up_figures(made).rise; });
  add("warm-up to 95 %", "s", sheet_.warm_up_s, 2e-2,
      [&] { return warm_up_figures(made).time; });
}

DesignedDevice Design::finished() {
  DesignedDevice result;
  set_mount();
  meet_frequency();
  // Each moves the others by little.
  for (int k = 0; k < 2; ++k) {
    meet_split();
    meet_quality();
    meet_frequency();
  }
  set_readout();
  set_noise();
  set_sensor();
  set_supply();
  keep_voltage(result.warnings);
  meet_bandwidth(result.warnings);
  meet_noise(result.warnings);
  meet_heating();
  result.text = text_.text(heading_);
  const Device made = device();
  add_figures(made, result);
  const auto range = sheet_.temperature_degC.value_or(std::pair(-40.0, 50.0));
  const double drift = bias_over(made, range);
  const double full_scale = text_.number("readout.full_scale_deg_per_s");
  if (drift > full_scale)
    result.warnings.push_back(fmt::format(
        "the bias changes by {:.4g} deg/s from {:g} to {:g} degC, beyond the "
        "full scale of {:g} deg/s",
        drift, range.first, range.second, full_scale));
  const std::vector<std::string> limits =
      characterise(made, even_temperatures(range.first, range.second, 1))
          .warnings;
  result.warnings.insert(result.warnings.end(), limits.begin(), limits.end());
  return result;
}

}  // namespace internal

bool DesignFigure::is_met() const {
  return std::abs(measured - asked) <= tolerance * std::abs(asked);
}

DesignedDevice design_device(const Device& base, const DataSheet& sheet) {
  internal::require_sound(sheet);
  if (!base.overrides().empty())
    throw std::invalid_argument(
        "the base has overrides; expected a device file as it is");
  return internal::Design(base, sheet).finished();
}

}  // namespace beamgyro
