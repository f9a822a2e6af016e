// SPDX-License-Identifier: MIT
#include "compensation/export/export_ekf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "config/units.h"
#include "dataset/files/json_text.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kEkf2Period = 0.01;   // [s], EKF2_PREDICT_US by default
constexpr double kEkf3Period = 0.012;  // [s], EKF_TARGET_DT
constexpr int kStates = 15;            // of robot_localization
constexpr int kFirstRate = 9;          // its vroll

constexpr const char* kPx4 = "PX4 EKF2";
constexpr const char* kArduPilot = "ArduPilot EKF3";
constexpr const char* kKalibr = "Kalibr";
constexpr const char* kRobotLocalization = "robot_localization";

constexpr const char* kPx4Source =
    "PX4-Autopilot: src/modules/ekf2/module.yaml, params_gyro_bias.yaml, "
    "EKF/covariance.cpp";
constexpr const char* kArduPilotSource =
    "ardupilot: libraries/AP_NavEKF3/AP_NavEKF3.cpp, AP_NavEKF3_core.cpp";
constexpr const char* kKalibrSource =
    "kalibr: wiki IMU-Noise-Model, kalibr_common/ConfigReader.py";
constexpr const char* kRobotSource =
    "robot_localization: params/ekf.yaml, src/ekf.cpp (P + Q dt); sensor_msgs "
    "Imu.msg";

const char* rate_name(char axis) {
  return axis == 'x' ? "vroll" : axis == 'y' ? "vpitch" : "vyaw";
}

// Place in a matrix of 15 x 15 that is written row by row.
int place_of(char axis) { return (kFirstRate + axis - 'x') * (kStates + 1); }

std::string six_digits(double value) { return fmt::format("{:.6g}", value); }

std::string filter_heading(const EkfExport& given, const char* filter) {
  return fmt::format(
      "# {}: noise of the gyro about {}, from {} and {}.\n"
      "# Bias noise at {:g} K/min; {}_ekf.json has every formula.\n",
      filter, given.axis, given.compensator.name, given.rest.name,
      given.settings.temperature_rate * 60.0, given.name);
}

template <class Line>
std::string filter_lines(const EkfExport& given, const char* filter,
                         Line line) {
  std::string text = filter_heading(given, filter);
  for (const FilterParameter& p : filter_parameters(given))
    if (p.filter == filter) text += line(p);
  return text;
}

std::string px4_text(const EkfExport& given) {
  return filter_lines(given, kPx4, [](const FilterParameter& p) {
    return fmt::format("1\t1\t{}\t{}\t9\n", p.name, six_digits(p.written));
  });
}

std::string ardupilot_text(const EkfExport& given) {
  return filter_lines(given, kArduPilot, [](const FilterParameter& p) {
    return fmt::format("{},{}\n", p.name, six_digits(p.written));
  });
}

std::string kalibr_text(const EkfExport& given) {
  return filter_lines(given, kKalibr,
                      [](const FilterParameter& p) {
                        return fmt::format("{}: {}  # {}\n", p.name,
                                           six_digits(p.written), p.unit);
                      }) +
         "# accelerometer_noise_density, accelerometer_random_walk and "
         "rostopic "
         "are yours.\n";
}

// The covariance of the rates in sensor_msgs/Imu is 3 x 3, those of the filter
// are 15 x 15, of which one element is known.
std::string robot_localization_text(const EkfExport& given) {
  const int rate = given.axis - 'x';
  return filter_lines(
      given, kRobotLocalization, [&](const FilterParameter& p) -> std::string {
        if (p.name == "angular_velocity_covariance") {
          std::string cells;
          for (int k = 0; k < 9; ++k)
            cells += fmt::format("{}{}", k == 0 ? "" : ", ",
                                 k == 4 * rate ? six_digits(p.written) : "0.0");
          return fmt::format(
              "# sensor_msgs/Imu that the driver publishes, {}\n{}: [{}]\n",
              p.unit, p.name, cells);
        }
        return fmt::format(
            "# {}: index {} (from 0) of 225, [{}, {}], {}\n{}_{}: {}\n", p.name,
            place_of(given.axis), rate_name(given.axis), rate_name(given.axis),
            p.unit, p.name, rate_name(given.axis), six_digits(p.written));
      });
}

Json figure(double value, const char* unit, const char* formula) {
  return {{"value", std::isfinite(value) ? Json(value) : Json()},
          {"unit", unit},
          {"formula", formula}};
}

Json figures_json(const EkfExport& given) {
  const EkfFigures& f = given.figures;
  Json json;
  json["power_on_bias_sigma"] =
      figure(f.power_on_sigma, "deg/s", "sigma_0 = sqrt(<sigma(T, 1, 0)^2>)");
  json["initial_bias_covariance"] =
      figure(std::pow(f.power_on_sigma * kDegree, 2), "(rad/s)^2", "sigma_0^2");
  json["temperature_bias_sigma"] =
      figure(f.temperature_sigma, "deg/s", "sqrt(<sigma(T, 0, 0)^2>)");
  json["noise_density"] =
      figure(f.noise_density, "deg/s/sqrt(Hz)", "N of the Allan deviation");
  json["base_bias_walk"] =
      figure(f.base_walk, "deg/s/sqrt(s)",
             given.noise.walk_is_bound
                 ? "largest K that the Allan deviation leaves room for"
                 : "K of the Allan deviation");
  json["bias_walk_over_temperature"] =
      figure(f.walk_per_root_kelvin, "deg/s/sqrt(K)",
             "sqrt(2 <sigma(T, 0, 0)^2> / L)");
  json["bias_walk"] =
      figure(f.bias_walk, "deg/s/sqrt(s)",
             "sqrt(Q) = sqrt(K^2 + 2 <sigma(T, 0, 0)^2> |r| / L + 2 s_r^2 / "
             "tau_rate)");
  json["bias_correlation_time"] = figure(f.correlation_time, "s", "L / |r|");
  json["flicker_correlation_time"] =
      figure(given.noise.flicker_time.value_or(NAN), "s",
             "middle of the flicker floor / 1.893");
  json["power_on_time_constant"] =
      figure(f.power_on_time.value_or(NAN), "s", "tau_on");
  return json;
}

Json parameter_json(const FilterParameter& p) {
  Json json{{"filter", p.filter},   {"name", p.name},      {"value", p.written},
            {"unit", p.unit},       {"computed", p.value}, {"range", nullptr},
            {"formula", p.formula}, {"source", p.source}};
  if (p.range) json["range"] = {p.range->first, p.range->second};
  return json;
}

std::string parameter_document(const EkfExport& given) {
  const auto source = [](const EkfSource& of) {
    return Json{{"name", of.name}, {"sha256", of.sha256}};
  };
  const EkfSettings& s = given.settings;
  Json json{{"filetype", "beamgyro-ekf"},
            {"format_version", 1},
            {"axis", std::string(1, given.axis)},
            {"compensator", source(given.compensator)},
            {"rest", source(given.rest)},
            {"temperature_degC", s.temperature ? Json(*s.temperature) : Json()},
            {"temperature_rate_K_per_min", s.temperature_rate * 60.0},
            {"correlation_K", s.correlation},
            {"figures", figures_json(given)}};
  Json& rest = json["rest"];
  rest["samples"] = given.noise.samples;
  rest["duration_s"] = given.noise.duration;
  rest["sample_rate_Hz"] = given.noise.sample_rate;
  rest["temperature_span_K"] = given.noise.temperature_span;
  rest["noise"] = to_json(given.noise.coefficients, "deg/s");
  json["parameters"] = Json::array();
  for (const FilterParameter& p : filter_parameters(given))
    json["parameters"].push_back(parameter_json(p));
  return json_text(json);
}

}  // namespace

std::vector<FilterParameter> filter_parameters(const EkfExport& given) {
  const double noise = given.figures.noise_density * kDegree;   // N
  const double walk = given.figures.bias_walk * kDegree;        // sqrt(Q)
  const double sigma = given.figures.power_on_sigma * kDegree;  // sigma_0
  const double rate = given.noise.sample_rate;
  const double measured = noise * noise * rate + sigma * sigma;
  // Both autopilots add (dt p)^2 a step.
  const double two = std::sqrt(kEkf2Period), three = std::sqrt(kEkf3Period);
  using Limits = std::pair<double, double>;
  std::vector<FilterParameter> all = {
      {kPx4, "EKF2_GYR_NOISE", "rad/s", noise / two, 0.0, Limits{1e-4, 0.1},
       "N / sqrt(0.01 s)", kPx4Source},
      {kPx4, "EKF2_GYR_B_NOISE", "rad/s^2", walk / two, 0.0, Limits{0.0, 0.01},
       "sqrt(Q / 0.01 s)", kPx4Source},
      {kPx4, "EKF2_GBIAS_INIT", "rad/s", sigma, 0.0, Limits{0.0, 0.2},
       "sigma_0", kPx4Source},
      {kArduPilot, "EK3_GYRO_P_NSE", "rad/s", noise / three, 0.0,
       Limits{1e-4, 0.1}, "N / sqrt(0.012 s)", kArduPilotSource},
      {kArduPilot, "EK3_GBIAS_P_NSE", "rad/s/s", walk / three, 0.0,
       Limits{1e-5, 1e-3}, "sqrt(Q / 0.012 s)", kArduPilotSource},
      {kKalibr, "gyroscope_noise_density", "rad/s/sqrt(Hz)", noise, 0.0,
       std::nullopt, "N", kKalibrSource},
      {kKalibr, "gyroscope_random_walk", "rad/s^2/sqrt(Hz)", walk, 0.0,
       std::nullopt, "sqrt(Q)", kKalibrSource},
      {kKalibr, "update_rate", "Hz", rate, 0.0, {}, "f", kKalibrSource},
      {kRobotLocalization, "angular_velocity_covariance", "(rad/s)^2", measured,
       0.0, std::nullopt, "N^2 f + sigma_0^2", kRobotSource},
      {kRobotLocalization, "process_noise_covariance", "(rad/s)^2/s",
       walk * walk, 0.0, std::nullopt, "Q", kRobotSource},
      {kRobotLocalization, "initial_estimate_covariance", "(rad/s)^2", measured,
       0.0, std::nullopt, "N^2 f + sigma_0^2", kRobotSource}};
  for (FilterParameter& each : all)
    each.written = each.range ? std::clamp(each.value, each.range->first,
                                           each.range->second)
                              : each.value;
  return all;
}

std::vector<std::pair<std::string, std::string>> ekf_texts(
    const EkfExport& given) {
  return {{given.name + "_ekf.json", parameter_document(given)},
          {given.name + "_ekf2.params", px4_text(given)},
          {given.name + "_ekf3.parm", ardupilot_text(given)},
          {given.name + "_imu.yaml", kalibr_text(given)},
          {given.name + "_robot_localization.yaml",
           robot_localization_text(given)}};
}

std::vector<std::string> ekf_warnings(const EkfExport& given) {
  std::vector<std::string> warnings;
  for (const FilterParameter& p : filter_parameters(given))
    if (p.is_clamped())
      warnings.push_back(fmt::format(
          "{}: {:.4g} {} lies outside {:g} to {:g}, which {} documents; {:g} "
          "is written",
          p.name, p.value, p.unit, p.range->first, p.range->second, p.filter,
          p.written));
  constexpr double kStillRest = 5.0;  // [K]
  if (given.noise.temperature_span > kStillRest)
    warnings.push_back(fmt::format(
        "{}: its temperature moves by {:.1f} K; the drift over it counts as "
        "rate random walk",
        given.rest.name, given.noise.temperature_span));
  return warnings;
}

}  // namespace beamgyro::internal
