// SPDX-License-Identifier: MIT
#include "compensation/export/export_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "compensation/export/parameter_lines.h"
#include "compensation/methods/autopilot_methods.h"
#include "config/option_message.h"
#include "config/units.h"

namespace beamgyro::internal {
namespace {

// Returns what the parameters cannot represent of this compensator, or an empty
// text.
std::string obstacle(const FittedCompensator& c) {
  if (c.scale_factor) return "it corrects the scale factor";
  if (std::holds_alternative<ConstantBias>(c.bias.function) ||
      std::holds_alternative<NoBias>(c.bias.function))
    return "";
  const auto* polynomial = std::get_if<Polynomial>(&c.bias.function);
  if (polynomial == nullptr)
    return fmt::format("it is of kind {}", kind_name(c.bias));
  if (!polynomial->slopes.empty() ||
      c.inputs != std::vector{parse_input("temperature")})
    return "it has other inputs than the temperature";
  if (polynomial->coefficients.size() > kCubicTerms)
    return fmt::format("its degree is {}", polynomial->coefficients.size() - 1);
  return "";
}

BiasModel as_polynomial(const BiasModel& bias) {
  if (const auto* constant = std::get_if<ConstantBias>(&bias.function))
    return {{Scale{}}, bias.bias_scale, Polynomial{{constant->value}}};
  if (std::holds_alternative<NoBias>(bias.function))
    return {{Scale{}}, bias.bias_scale, Polynomial{{0.0}}};
  return bias;
}

}  // namespace

char upper_axis(char axis) { return static_cast<char>(axis - 'x' + 'X'); }

std::vector<double> cubic_coefficients(const std::vector<AutopilotAxis>& axes,
                                       char name, double reference) {
  const auto found = std::ranges::find(axes, name, &AutopilotAxis::axis);
  std::vector<double> c;
  if (found != axes.end()) c = coefficients_about(found->cubic, reference);
  c.resize(kCubicTerms, 0.0);
  for (double& each : c) each *= kDegree;
  return c;
}

std::string parameter_heading(const char* what,
                              const std::vector<AutopilotAxis>& axes) {
  std::string text = fmt::format("# {} of", what);
  for (const AutopilotAxis& axis : axes) text += fmt::format(" {}", axis.axis);
  return text;
}

std::string single_precision(double value) {
  return fmt::format("{:.9g}", static_cast<float>(value));
}

void add_line(std::string& text, const std::string& name,
              const std::string& value) {
  text += fmt::format("{},{}\n", name, value);
}

void require_ardupilot_gyro(const AutopilotGyro& gyro) {
  if (gyro.instance < 1 || gyro.instance > 3)
    throw std::invalid_argument(fmt::format(
        "instance {}: ArduPilot has the gyros 1 to 3", gyro.instance));
}

TemperatureRange ardupilot_range(const std::vector<AutopilotAxis>& axes) {
  const TemperatureRange range = common_range(axes);
  if (range.lowest < -70.0 || range.highest > 80.0 ||
      range.highest - range.lowest < kArduPilotSpan)
    throw std::invalid_argument(fmt::format(
        "the temperatures {:.2f} to {:.2f} degC that were seen are none that "
        "ArduPilot accepts: within -70 to 80 degC and {} K apart",
        range.lowest, range.highest, kArduPilotSpan));
  return range;
}

BiasModel autopilot_cubic(const FittedCompensator& c, bool fit_cubic) {
  const std::string reason = obstacle(c);
  if (reason.empty()) return as_polynomial(c.bias);
  if (fit_cubic) return c.baseline;
  const Provenance& p = c.provenance;
  const bool both = p.held_out_rms && p.baseline_held_out_rms;
  throw option_error(
      "the format holds a cubic of the temperature, and of this compensator "
      "{}; a cubic fitted to the same rows has {:.4g} deg/s rms in-sample{} "
      "where this one has {:.4g}{}; {} exports it",
      reason, p.baseline_in_sample_rms,
      both ? fmt::format(" and {:.4g} held-out", *p.baseline_held_out_rms) : "",
      p.in_sample_rms, both ? fmt::format(" and {:.4g}", *p.held_out_rms) : "",
      NamedOption{"fit_cubic"});
}

TemperatureRange common_range(const std::vector<AutopilotAxis>& axes) {
  TemperatureRange common;
  for (const AutopilotAxis& axis : axes) {
    common.lowest = std::max(common.lowest, axis.range.lowest);
    common.highest = std::min(common.highest, axis.range.highest);
  }
  if (!(common.lowest <= common.highest))
    throw std::invalid_argument(fmt::format(
        "no temperature is common to the axes, of which one was trained from "
        "{:.2f} degC up and one up to {:.2f} degC; an autopilot has one range "
        "for all axes of a gyro",
        common.lowest, common.highest));
  return common;
}

std::string px4_parameters(const std::vector<AutopilotAxis>& axes,
                           const AutopilotGyro& gyro) {
  if (gyro.instance < 0 || gyro.instance > 3)
    throw std::invalid_argument(
        fmt::format("instance {}: PX4 has the gyros 0 to 3", gyro.instance));
  const TemperatureRange range = common_range(axes);
  // The reference is rounded to single precision, too, and the coefficients
  // belong to the rounded value.
  const auto reference =
      static_cast<float>(0.5 * (range.lowest + range.highest));
  std::string text = parameter_heading("PX4 thermal compensation", axes) +
                     "; set the CAL_GYRO offsets to 0\n";
  const auto row = [&](const std::string& name, const std::string& value,
                       int type) {
    text += fmt::format("1\t1\t{}\t{}\t{}\n", name, value, type);
  };
  const std::string prefix = fmt::format("TC_G{}_", gyro.instance);
  row("TC_G_ENABLE", "1", 6);
  row(prefix + "ID", std::to_string(gyro.device_id), 6);
  row(prefix + "TREF", single_precision(reference), 9);
  row(prefix + "TMIN", single_precision(range.lowest), 9);
  row(prefix + "TMAX", single_precision(range.highest), 9);
  for (std::size_t k = 0; k < kCubicTerms; ++k)
    for (const char axis : kAutopilotAxes)
      row(fmt::format("{}X{}_{}", prefix, k, axis - 'x'),
          single_precision(cubic_coefficients(axes, axis, reference)[k]), 9);
  return text;
}

std::string ardupilot_parameters(const std::vector<AutopilotAxis>& axes,
                                 const AutopilotGyro& gyro) {
  require_ardupilot_gyro(gyro);
  const int n = gyro.instance;
  const TemperatureRange range = ardupilot_range(axes);
  // Clamped as the autopilot does, so that the offset belongs to the value that
  // it uses.
  const double at = std::clamp(static_cast<float>(kArduPilotReference),
                               static_cast<float>(range.lowest),
                               static_cast<float>(range.highest));
  std::string text =
      parameter_heading("ArduPilot temperature calibration", axes) + "\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    add_line(text, name, value);
  };
  const std::string calibration = fmt::format("INS_TCAL{}_", n);
  line(calibration + "ENABLE", "1");
  line(calibration + "TMIN", single_precision(range.lowest));
  line(calibration + "TMAX", single_precision(range.highest));
  for (std::size_t k = 1; k < kCubicTerms; ++k)
    for (const char axis : kAutopilotAxes)
      line(fmt::format("{}GYR{}_{}", calibration, k, upper_axis(axis)),
           single_precision(
               1e6 * cubic_coefficients(axes, axis, kArduPilotReference)[k]));
  line(fmt::format("INS_GYR{}_CALTEMP", n), single_precision(at));
  for (const char axis : kAutopilotAxes)
    line(fmt::format("INS_GYR{}OFFS_{}", n == 1 ? "" : std::to_string(n),
                     upper_axis(axis)),
         single_precision(cubic_coefficients(axes, axis, at)[0]));
  return text;
}

}  // namespace beamgyro::internal
