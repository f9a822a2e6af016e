// SPDX-License-Identifier: MIT
#include "compensation/export_parameters.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "compensation/autopilot_fits.h"
#include "config/units.h"

namespace beamgyro {
namespace {

constexpr std::size_t kTerms = 4;  // of a cubic

// What the parameters cannot say of this compensator; empty when nothing.
std::string obstacle(const Compensator& c) {
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
  if (polynomial->coefficients.size() > kTerms)
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

// c_0 ... c_3 about the reference [rad/s/K^k].
std::vector<double> coefficients(const BiasModel& cubic, double reference) {
  std::vector<double> c = coefficients_about(cubic, reference);
  c.resize(kTerms, 0.0);
  for (double& each : c) each *= kDegree;
  return c;
}

int axis_index(char axis) { return axis - 'x'; }

// As many digits as a single has.
std::string number(double value) {
  return fmt::format("{:.9g}", static_cast<float>(value));
}

}  // namespace

BiasModel autopilot_cubic(const Compensator& c, bool fit_cubic) {
  const std::string reason = obstacle(c);
  if (reason.empty()) return as_polynomial(c.bias);
  if (fit_cubic) return c.baseline;
  const Provenance& p = c.provenance;
  const bool both = p.held_out_rms && p.baseline_held_out_rms;
  throw std::invalid_argument(fmt::format(
      "the format holds a cubic of the temperature, and of this compensator "
      "{}; "
      "a cubic fitted to the same rows has {:.4g} deg/s rms in-sample{} where "
      "this one has {:.4g}{}; --fit-cubic exports it",
      reason, p.baseline_in_sample_rms,
      both ? fmt::format(" and {:.4g} held-out", *p.baseline_held_out_rms) : "",
      p.in_sample_rms,
      both ? fmt::format(" and {:.4g}", *p.held_out_rms) : ""));
}

std::string px4_parameters(const BiasModel& cubic,
                           const TemperatureRange& range,
                           const AutopilotPlace& place) {
  if (place.instance < 0 || place.instance > 3)
    throw std::invalid_argument(
        fmt::format("instance {}: PX4 has the gyros 0 to 3", place.instance));
  // The reference is a single, too; the coefficients belong to what it holds.
  const auto reference =
      static_cast<float>(0.5 * (range.lowest + range.highest));
  const std::vector<double> c = coefficients(cubic, reference);
  std::string text =
      "# PX4 thermal compensation of one axis; set its CAL_GYRO offsets to 0\n";
  const auto row = [&](const std::string& name, const std::string& value,
                       int type) {
    text += fmt::format("1\t1\t{}\t{}\t{}\n", name, value, type);
  };
  const std::string gyro = fmt::format("TC_G{}_", place.instance);
  row("TC_G_ENABLE", "1", 6);
  row(gyro + "ID", std::to_string(place.device_id), 6);
  row(gyro + "TREF", number(reference), 9);
  row(gyro + "TMIN", number(range.lowest), 9);
  row(gyro + "TMAX", number(range.highest), 9);
  for (std::size_t k = 0; k < kTerms; ++k)
    for (int axis = 0; axis < 3; ++axis)
      row(fmt::format("{}X{}_{}", gyro, k, axis),
          number(axis == axis_index(place.axis) ? c[k] : 0.0), 9);
  return text;
}

std::string ardupilot_parameters(const BiasModel& cubic,
                                 const TemperatureRange& range,
                                 const AutopilotPlace& place) {
  if (place.instance < 1 || place.instance > 3)
    throw std::invalid_argument(fmt::format(
        "instance {}: ArduPilot has the gyros 1 to 3", place.instance));
  if (range.lowest < -70.0 || range.highest > 80.0 ||
      range.highest - range.lowest < kArduPilotSpan)
    throw std::invalid_argument(fmt::format(
        "the temperatures of training, {:.2f} to {:.2f} degC, are none that "
        "ArduPilot accepts: within -70 to 80 degC and {} K apart",
        range.lowest, range.highest, kArduPilotSpan));
  const std::vector<double> c = coefficients(cubic, kArduPilotReference);
  const int n = place.instance;
  std::string text = "# ArduPilot temperature calibration of one axis\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{},{}\n", name, value);
  };
  const std::string calibration = fmt::format("INS_TCAL{}_", n);
  line(calibration + "ENABLE", "1");
  line(calibration + "TMIN", number(range.lowest));
  line(calibration + "TMAX", number(range.highest));
  for (std::size_t k = 1; k < kTerms; ++k)
    for (const char axis : {'x', 'y', 'z'})
      line(fmt::format("{}GYR{}_{}", calibration, k,
                       static_cast<char>(std::toupper(axis))),
           number(axis == place.axis ? 1e6 * c[k] : 0.0));
  line(fmt::format("INS_GYR{}_CALTEMP", n), number(kArduPilotReference));
  for (const char axis : {'x', 'y', 'z'})
    line(fmt::format("INS_GYR{}OFFS_{}", n == 1 ? "" : std::to_string(n),
                     static_cast<char>(std::toupper(axis))),
         number(axis == place.axis ? c[0] : 0.0));
  return text;
}

}  // namespace beamgyro
