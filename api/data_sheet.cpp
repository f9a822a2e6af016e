// SPDX-License-Identifier: MIT
#include "api/data_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "api/checked_number.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

const double kPairOverCorner = std::sqrt(std::numbers::sqrt2 - 1);

namespace {

// Within it two figures of a sheet are one quantity, rounded twice.
constexpr double kSame = 0.05;

NamedOption option(const char* name, double value) {
  return {name, fmt::format("{:g}", value)};
}

bool differ(double a, double b) {
  return std::abs(a - b) > kSame * std::max(std::abs(a), std::abs(b));
}

void check_ranges(const DataSheet& s) {
  check_number("length", s.length, {1e-4, 0.5});
  check_number("side", s.side, {1e-5, 0.1});
  check_number("frequency_Hz", s.frequency_Hz, {500, 1e6});
  check_number("split_Hz", s.split_Hz, positive());
  check_number("quality", s.quality, {5, 1e6});
  check_number("air_quality", s.air_quality, {5, 1e9});
  for (const auto& [name, value] :
       {std::pair("range_deg_per_s", s.range_deg_per_s),
        std::pair("full_scale_deg_per_s", s.full_scale_deg_per_s)})
    check_number(name, value, {0, 1e4, true, false});
  check_number("scale_factor_V_per_deg_per_s", s.scale_factor_V_per_deg_per_s,
               positive());
  check_number("bandwidth_Hz", s.bandwidth_Hz, {0.5, 500});
  for (const auto& [name, value] :
       {std::pair("noise_deg_per_s_per_sqrt_Hz", s.noise_deg_per_s_per_sqrt_Hz),
        std::pair("walk_deg_per_sqrt_h", s.walk_deg_per_sqrt_h),
        std::pair("instability_deg_per_h", s.instability_deg_per_h),
        std::pair("null_deg_per_s", s.null_deg_per_s),
        std::pair("sensor_tolerance_K", s.sensor_tolerance_K)})
    check_number(name, value, non_negative());
  check_number("scale_tolerance_percent", s.scale_tolerance_percent,
               between(0, 50));
  check_number("resolution_K", s.resolution_K, {0, 20, true, false});
  check_number("supply_V", s.supply_V, {0, 1e3, true, false});
  check_number("current_A", s.current_A, {0, 10, true, false});
  check_number("power_W", s.power_W, {0, 100, true, false});
  check_number("self_heating_K", s.self_heating_K, {0.05, 100});
  check_number("warm_up_s", s.warm_up_s, {2, 20000});
  for (const auto& [name, range] :
       {std::pair("sensor_range_degC", s.sensor_range_degC),
        std::pair("temperature_degC", s.temperature_degC)})
    if (range)
      check_range(name, range->first, range->second, kMaterialTemperatures);
  for (const auto& [name, bits] :
       {std::pair("adc_bits", s.adc_bits), std::pair("bits", s.bits)})
    if (bits && (*bits < 2 || *bits > 32))
      throw option_error("{}; expected 2 to 32",
                         NamedOption{name, std::to_string(*bits)});
  if (!s.mount.empty() && s.mount != "elastomer" && s.mount != "epoxy" &&
      s.mount != "metal")
    throw option_error("{}; expected elastomer, epoxy or metal",
                       NamedOption{"mount", s.mount});
}

void check_beam(const DataSheet& s) {
  if (s.length && s.side && !is_beam(*s.length, *s.side))
    throw option_error(
        "{} and {}: no beam; expected one {:g} to {:g} times as long as thick",
        option("length", *s.length), option("side", *s.side), kStoutest,
        kSlenderest);
  if (s.quality && s.air_quality && *s.air_quality <= *s.quality)
    throw option_error(
        "{} and {}: the gas alone leaves less than the gyro is to have; "
        "expected a quality factor below that of the gas",
        option("quality", *s.quality), option("air_quality", *s.air_quality));
  if (s.bandwidth_Hz && s.split_Hz && *s.bandwidth_Hz >= 0.5 * *s.split_Hz)
    throw option_error(
        "{} and {}: the sense mode answers up to about half of the split; "
        "expected a smaller bandwidth",
        option("bandwidth_Hz", *s.bandwidth_Hz),
        option("split_Hz", *s.split_Hz));
  if (s.frequency_Hz && s.split_Hz && *s.split_Hz > 0.2 * *s.frequency_Hz)
    throw option_error(
        "{} and {}: expected a split of at most a fifth of the "
        "frequency",
        option("frequency_Hz", *s.frequency_Hz),
        option("split_Hz", *s.split_Hz));
}

void check_readout(const DataSheet& s) {
  if (s.range_deg_per_s && s.full_scale_deg_per_s &&
      *s.range_deg_per_s > *s.full_scale_deg_per_s)
    throw option_error(
        "{} is beyond {}; expected a range within the full scale",
        option("range_deg_per_s", *s.range_deg_per_s),
        option("full_scale_deg_per_s", *s.full_scale_deg_per_s));
  const auto full_scale = full_scale_of(s);
  if (s.scale_factor_V_per_deg_per_s && full_scale && s.supply_V &&
      *s.scale_factor_V_per_deg_per_s * *full_scale > 0.5 * *s.supply_V)
    throw option_error(
        "{}: {:g} deg/s are {:g} V, and half of {} is all there is",
        option("scale_factor_V_per_deg_per_s", *s.scale_factor_V_per_deg_per_s),
        *full_scale, *s.scale_factor_V_per_deg_per_s * *full_scale,
        option("supply_V", *s.supply_V));
  if (s.null_deg_per_s && full_scale && *s.null_deg_per_s >= *full_scale)
    throw option_error("{}: beyond the full scale of {:g} deg/s",
                       option("null_deg_per_s", *s.null_deg_per_s),
                       *full_scale);
  if (s.noise_deg_per_s_per_sqrt_Hz && s.walk_deg_per_sqrt_h) {
    const double walk =
        *s.noise_deg_per_s_per_sqrt_Hz / std::numbers::sqrt2 * 60;
    if (differ(walk, *s.walk_deg_per_sqrt_h))
      throw option_error(
          "{} is a walk of {:.4g} deg/sqrt(h), {} says another; expected one "
          "of them",
          option("noise_deg_per_s_per_sqrt_Hz", *s.noise_deg_per_s_per_sqrt_Hz),
          walk, option("walk_deg_per_sqrt_h", *s.walk_deg_per_sqrt_h));
  }
}

void check_sensor(const DataSheet& s) {
  const auto range = s.sensor_range_degC.value_or(kSensorRange);
  if (s.bits && s.resolution_K) {
    const double step = (range.second - range.first) / std::exp2(*s.bits);
    if (differ(step, *s.resolution_K))
      throw option_error(
          "{} over {:g} to {:g} degC are steps of {:.4g} K, {} says another; "
          "expected one of them",
          NamedOption{"bits", std::to_string(*s.bits)}, range.first,
          range.second, step, option("resolution_K", *s.resolution_K));
  }
  if (s.sensor_range_degC && s.temperature_degC &&
      (s.temperature_degC->first < range.first ||
       s.temperature_degC->second > range.second))
    throw option_error(
        "{}: the unit works from {:g} to {:g} degC, beyond what its sensor "
        "shows",
        NamedOption{"sensor_range_degC",
                    fmt::format("{:g}:{:g}", range.first, range.second)},
        s.temperature_degC->first, s.temperature_degC->second);
  if (s.sensor_range_degC && !s.bits)
    throw option_error("{} says nothing without {}",
                       NamedOption{"sensor_range_degC"}, NamedOption{"bits"});
}

void check_supply(const DataSheet& s) {
  if (s.current_A && !s.supply_V)
    throw option_error("{}: of what voltage? expected {} with it",
                       option("current_A", *s.current_A),
                       NamedOption{"supply_V", "V"});
  if (s.current_A && s.power_W &&
      differ(*s.current_A * *s.supply_V, *s.power_W))
    throw option_error(
        "{} at {} are {:.4g} W, {} says another; expected one of them",
        option("current_A", *s.current_A), option("supply_V", *s.supply_V),
        *s.current_A * *s.supply_V, option("power_W", *s.power_W));
}

}  // namespace

std::optional<double> walk_of(const DataSheet& s) {
  if (s.noise_deg_per_s_per_sqrt_Hz)
    return *s.noise_deg_per_s_per_sqrt_Hz / std::numbers::sqrt2;
  if (s.walk_deg_per_sqrt_h) return *s.walk_deg_per_sqrt_h / 60;
  return {};
}

std::optional<double> resolution_of(const DataSheet& s) {
  if (s.resolution_K) return s.resolution_K;
  if (!s.bits) return {};
  const auto range = s.sensor_range_degC.value_or(kSensorRange);
  return (range.second - range.first) / std::exp2(*s.bits);
}

std::optional<double> power_of(const DataSheet& s) {
  if (s.power_W) return s.power_W;
  if (s.current_A && s.supply_V) return *s.current_A * *s.supply_V;
  return {};
}

std::optional<double> full_scale_of(const DataSheet& s) {
  return s.full_scale_deg_per_s ? s.full_scale_deg_per_s : s.range_deg_per_s;
}

std::vector<std::string> figures_of(const DataSheet& s) {
  std::vector<std::string> figures;
  const auto add = [&](const char* name, const auto& value) {
    if (value) figures.push_back(fmt::format("{} = {:g}", name, 1.0 * *value));
  };
  const auto add_range = [&](const char* name, const auto& range) {
    if (range)
      figures.push_back(
          fmt::format("{} = {:g}:{:g}", name, range->first, range->second));
  };
  add("length", s.length);
  add("side", s.side);
  add("frequency_Hz", s.frequency_Hz);
  add("split_Hz", s.split_Hz);
  add("quality", s.quality);
  add("air_quality", s.air_quality);
  if (!s.mount.empty()) figures.push_back("mount = " + s.mount);
  add("range_deg_per_s", s.range_deg_per_s);
  add("full_scale_deg_per_s", s.full_scale_deg_per_s);
  add("scale_factor_V_per_deg_per_s", s.scale_factor_V_per_deg_per_s);
  add("bandwidth_Hz", s.bandwidth_Hz);
  add("noise_deg_per_s_per_sqrt_Hz", s.noise_deg_per_s_per_sqrt_Hz);
  add("walk_deg_per_sqrt_h", s.walk_deg_per_sqrt_h);
  add("instability_deg_per_h", s.instability_deg_per_h);
  add("null_deg_per_s", s.null_deg_per_s);
  add("scale_tolerance_percent", s.scale_tolerance_percent);
  add("adc_bits", s.adc_bits);
  add("bits", s.bits);
  add_range("sensor_range_degC", s.sensor_range_degC);
  add("resolution_K", s.resolution_K);
  add("sensor_tolerance_K", s.sensor_tolerance_K);
  add("supply_V", s.supply_V);
  add("current_A", s.current_A);
  add("power_W", s.power_W);
  add("self_heating_K", s.self_heating_K);
  add("warm_up_s", s.warm_up_s);
  add_range("temperature_degC", s.temperature_degC);
  return figures;
}

bool is_beam(double length, double side) {
  return side <= length / kStoutest && side >= length / kSlenderest;
}

void require_sound(const DataSheet& sheet) {
  check_ranges(sheet);
  check_beam(sheet);
  check_readout(sheet);
  check_sensor(sheet);
  check_supply(sheet);
}

}  // namespace beamgyro::internal
