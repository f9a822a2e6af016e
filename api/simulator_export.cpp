// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "api/checked_number.h"
#include "api/compensators.h"
#include "api/export_parts.h"
#include "api/rest_runs.h"
#include "api/scenario_state.h"
#include "compensation/export/export_parameters.h"
#include "compensation/export/export_sdf.h"
#include "compensation/export/export_sitl.h"
#include "compensation/firmware/c_text.h"
#include "config/units.h"
#include "include/beamgyro/export.h"
#include "sim/dynamics/mechanical_noise.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro {
namespace internal {
namespace {

struct SimulatorRequest {
  const std::vector<Device>& devices;
  const std::vector<Compensator>& compensators;
  const SimulatorExportOptions& options;
};

// As files and messages name it, whatever its folder.
std::string file_name(const Device& device) {
  return std::filesystem::path(device.name()).filename().string();
}

double cubic_at(const BiasModel& cubic, double temperature) {
  return cubic.predict(Eigen::ArrayXXd::Constant(1, 1, temperature))(0);
}

struct Residual {
  double rms = 0, largest = 0;
};

template <class Difference>
Residual sizes_of_differences(std::size_t count, Difference difference) {
  Residual found;
  for (std::size_t k = 0; k < count; ++k) {
    const double d = difference(k);
    found.rms += d * d / static_cast<double>(count);
    found.largest = std::max(found.largest, std::abs(d));
  }
  found.rms = std::sqrt(found.rms);
  return found;
}

// The drift of one device as an axis of the disturbance.
AutopilotAxis disturbance_of(const Device& device, char axis,
                             const RestCurve& soaks,
                             std::vector<std::string>& remarks) {
  const auto [coldest, hottest] = std::ranges::minmax(soaks.temperature);
  AutopilotAxis drift{axis,
                      disturbance_cubic(soaks.temperature, soaks.bias),
                      {coldest, hottest}};
  const Residual left =
      sizes_of_differences(soaks.bias.size(), [&](std::size_t k) {
        return soaks.bias[k] - cubic_at(drift.cubic, soaks.temperature[k]);
      });
  const auto [lowest, highest] = std::ranges::minmax(soaks.bias);
  remarks.push_back(fmt::format(
      "{}: {} drifts by {:.4g} deg/s from {:.2f} to {:.2f} degC of its sensor, "
      "swept upwards; a cubic leaves {:.4g} deg/s rms, {:.4g} deg/s at most",
      axis, file_name(device), highest - lowest, coldest, hottest, left.rms,
      left.largest));
  return drift;
}

void say_warm_up(const Device& device, const AutopilotAxis& drift,
                 const WarmUpFit& fit, const RestCurve& run,
                 std::vector<std::string>& remarks,
                 std::vector<std::string>& warnings) {
  const double hours = std::round((run.time.back() + run.time[1]) / 3600);
  if (fit.start == fit.end) {
    warnings.push_back(fmt::format(
        "{}: does not warm up: its sensor moves by less than {:g} K in {:g} h; "
        "SIM_IMUT_START and SIM_IMUT_END are equal",
        device.name(), kLeastRise, hours));
    return;
  }
  const Residual other =
      sizes_of_differences(run.time.size(), [&](std::size_t k) {
        return run.bias[k] -
               cubic_at(drift.cubic, warm_up_temperature(fit, run.time[k]));
      });
  remarks.push_back(fmt::format(
      "warm-up from {:.2f} to {:.2f} degC with one time constant of {:.4g} s, "
      "fitted to {:g} h of {}: {:.2g} K rms, {:.2g} K at most are left",
      fit.start, fit.end, fit.time_constant, hours, file_name(device), fit.rms,
      fit.largest));
  remarks.push_back(fmt::format(
      "there the disturbance differs from the bias of {} by {:.2g} deg/s rms, "
      "{:.2g} deg/s at most: what the cubic leaves, and a beam that is warm "
      "later than the sensor",
      file_name(device), other.rms, other.largest));
  if (fit.end > drift.range.highest || fit.start < drift.range.lowest)
    warnings.push_back(fmt::format(
        "{}: the warm-up leaves {:.2f} to {:.2f} degC, where the cubic is "
        "fitted; SITL extends it without limits, and the compensation clamps",
        device.name(), drift.range.lowest, drift.range.highest));
}

// What the two leave between them, where the compensation does not clamp.
void say_what_is_left(const AutopilotAxis& drift, const AutopilotAxis& taken,
                      std::vector<std::string>& remarks) {
  constexpr std::size_t kPlaces = 201;
  const TemperatureRange common = common_range({drift, taken});
  const Residual left = sizes_of_differences(kPlaces, [&](std::size_t k) {
    const double T = common.lowest + (common.highest - common.lowest) *
                                         static_cast<double>(k) / (kPlaces - 1);
    return cubic_at(drift.cubic, T) - cubic_at(taken.cubic, T);
  });
  remarks.push_back(fmt::format(
      "{}: disturbance less compensation is {:.3g} deg/s rms, {:.3g} deg/s at "
      "most, from {:.2f} to {:.2f} degC",
      drift.axis, left.rms, left.largest, common.lowest, common.highest));
}

std::vector<AutopilotAxis> compensation_axes(const SimulatorRequest& asked,
                                             const std::vector<char>& places) {
  std::vector<AutopilotAxis> axes;
  for (std::size_t k = 0; k < asked.compensators.size(); ++k) {
    const CompensatorState& own = asked.compensators[k].content();
    axes.push_back({places[k],
                    of_file(own.path(),
                            [&] {
                              return autopilot_cubic(own.compensator,
                                                     asked.options.fit_cubic);
                            }),
                    own.compensator.temperature_range});
  }
  return axes;
}

// Leaves e^-12 of the warm-up, and half an hour more for the beam [s].
double hold_after(const WarmUpFit& fit) {
  return 12 * fit.time_constant + 1800;
}

// Each of the devices, and the warm-up of the first: the temperature of SITL's
// sensors is one for all.
std::vector<AutopilotAxis> disturbance_axes(const SimulatorRequest& asked,
                                            const std::vector<char>& places,
                                            std::optional<WarmUpFit>& warm_up,
                                            ExportResult& result) {
  std::vector<AutopilotAxis> axes;
  const std::pair<double, double> range =
      asked.options.range_degC.value_or(std::pair(-40.0, 50.0));
  const double ambient = asked.options.temperature_degC.value_or(25);
  for (std::size_t k = 0; k < asked.devices.size(); ++k) {
    const Device& device = asked.devices[k];
    const RestCurve run = warm_up_run(device, ambient, result.warnings);
    const WarmUpFit fit = fit_warm_up(run.time, run.temperature);
    axes.push_back(disturbance_of(
        device, places[k],
        swept_soaks(device, range, hold_after(fit), result.warnings),
        result.remarks));
    if (k > 0) continue;
    warm_up = fit;
    say_warm_up(device, axes[0], fit, run, result.remarks, result.warnings);
  }
  return axes;
}

void sitl_files(const SimulatorRequest& asked, const std::string& name,
                ExportResult& result) {
  const std::size_t devices = asked.devices.size();
  const std::size_t compensators = asked.compensators.size();
  if (devices > 0 && compensators > 0 && devices != compensators)
    throw std::invalid_argument(fmt::format(
        "{} devices and {} compensators; expected as many, one of each for an "
        "axis",
        devices, compensators));
  const std::vector<char> places =
      axes_of(asked.options.axes, std::max(devices, compensators),
              devices > 0 ? "devices" : "compensators");
  const AutopilotGyro gyro{asked.options.instance.value_or(1)};
  std::vector<AutopilotAxis> taken = compensation_axes(asked, places);
  std::optional<WarmUpFit> warm_up;
  std::vector<AutopilotAxis> drift =
      devices > 0 ? disturbance_axes(asked, places, warm_up, result) : taken;
  if (devices > 0 && compensators > 0)
    for (std::size_t k = 0; k < devices; ++k)
      say_what_is_left(drift[k], taken[k], result.remarks);
  if (compensators == 0) taken = drift;
  const std::string first = devices > 0
                                ? asked.devices[0].name()
                                : asked.compensators[0].content().path();
  result.files = of_file(first, [&] {
    return std::vector<ExportedFile>{
        {name + "_sitl.parm",
         sitl_parameters(drift, gyro, warm_up, result.remarks)},
        {name + ".parm", ardupilot_parameters(taken, gyro)}};
  });
}

std::vector<std::string> sdf_remarks(const Device& device,
                                     const SdfNoise& noise, double ambient) {
  const NoiseParameters& own = device.content().device.noise;
  std::vector<std::string> remarks = {
      fmt::format("{}: rates in rad/s, of samples at {:g} Hz; at another rate "
                  "f scale stddev by sqrt(f/{:g})",
                  file_name(device), noise.update_rate, noise.update_rate),
      fmt::format("mean is the bias at rest in still air at {:g} degC, warmed "
                  "up: {:.4g} deg/s; left out is how it drifts with the "
                  "temperature and warms up",
                  ambient, noise.mean / kDegree),
      std::string("bias_mean is 0: Gazebo gives it a random sign. bias_stddev "
                  "is the turn-on offset"),
      fmt::format("dynamic_bias_stddev is a walk in rad/s/sqrt(s), no standard "
                  "deviation; it makes the turn-on offset fade over {:g} h",
                  noise.walk_correlation / 3600),
      fmt::format("left out: the bias instability of {:g} deg/s, scale factor, "
                  "bandwidth, saturation and g-sensitivity",
                  own.bias_instability / kDegree)};
  if (noise.resolution <= kSdfLeastPrecision)
    remarks.push_back(fmt::format(
        "left out: the resolution of {:.2g} rad/s, which Gazebo takes for none",
        noise.resolution));
  return remarks;
}

void sdf_file(const SimulatorRequest& asked, const std::string& name,
              ExportResult& result) {
  if (asked.devices.size() != 1 || !asked.compensators.empty())
    throw std::invalid_argument(fmt::format(
        "{} devices and {} compensators; expected one device: an SDF file "
        "holds the noise of a gyro, not its compensation",
        asked.devices.size(), asked.compensators.size()));
  const Device& device = asked.devices[0];
  const DeviceParameters& own = device.content().device;
  const NoiseParameters shown = output_noise(gyro_of(device));
  const double ambient = asked.options.temperature_degC.value_or(25);
  const RestCurve run = warm_up_run(device, ambient, result.warnings);
  const SdfNoise noise{
      .update_rate = asked.options.update_rate_Hz.value_or(100),
      .mean = run.bias.back() * kDegree,
      .angle_random_walk = shown.angle_random_walk,
      .turn_on = shown.turn_on,
      .rate_random_walk = shown.rate_random_walk,
      .walk_correlation = shown.walk_correlation,
      .resolution = 2 * own.readout.full_scale /
                    std::exp2(static_cast<double>(own.readout.adc_bits))};
  const char axis = axes_of(asked.options.axes, 1, "devices")[0];
  result.remarks = sdf_remarks(device, noise, ambient);
  result.files = {
      {name + ".sdf", sdf_sensor(name, axis, noise, result.remarks)}};
}

void require_simulator_options(const SimulatorRequest& asked,
                               const std::string& format) {
  if (format != "ardupilot-sitl" && format != "sdf")
    throw std::invalid_argument(
        fmt::format("format \"{}\"; expected ardupilot-sitl or sdf", format));
  const SimulatorExportOptions& o = asked.options;
  require_axes(o.axes);
  const bool is_sdf = format == "sdf";
  const std::pair<bool, const char*> others[] = {
      {is_sdf && o.instance, "instance"},
      {is_sdf && o.fit_cubic, "fit_cubic"},
      {is_sdf && o.range_degC, "range_degC"},
      {!is_sdf && o.update_rate_Hz, "update_rate_Hz"}};
  for (const auto& [given, option] : others)
    if (given)
      throw option_error("{}: is for the format {}, not for {}",
                         NamedOption{option}, is_sdf ? "ardupilot-sitl" : "sdf",
                         format);
  check_number("temperature_degC", o.temperature_degC, kMaterialTemperatures);
  check_number("update_rate_Hz", o.update_rate_Hz, {0, 1e5, true, true});
  if (o.range_degC)
    check_range("range_degC", o.range_degC->first, o.range_degC->second,
                kMaterialTemperatures);
  if (asked.devices.size() > 3 || asked.compensators.size() > 3)
    throw std::invalid_argument(fmt::format(
        "{} devices and {} compensators; expected up to three of each",
        asked.devices.size(), asked.compensators.size()));
  if (asked.devices.empty() && asked.compensators.empty())
    throw std::invalid_argument("no device and no compensator; expected one");
  if (asked.devices.empty())
    for (const auto& [given, option] :
         {std::pair(o.range_degC.has_value(), "range_degC"),
          std::pair(o.temperature_degC.has_value(), "temperature_degC")})
      if (given)
        throw option_error("{}: is for devices, of which there is none",
                           NamedOption{option});
}

}  // namespace
}  // namespace internal

ExportResult export_for_simulator(const std::vector<Device>& devices,
                                  const std::vector<Compensator>& compensators,
                                  const std::string& format,
                                  const SimulatorExportOptions& options) {
  const internal::SimulatorRequest asked{devices, compensators, options};
  internal::require_simulator_options(asked, format);
  std::string name = options.name;
  if (name.empty())
    name = std::filesystem::path(devices.empty() ? compensators[0].name()
                                                 : devices[0].name())
               .stem()
               .string();
  name = internal::c_identifier(name);
  ExportResult result;
  if (format == "sdf")
    internal::sdf_file(asked, name, result);
  else
    internal::sitl_files(asked, name, result);
  return result;
}

}  // namespace beamgyro
