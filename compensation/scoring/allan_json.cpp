// SPDX-License-Identifier: MIT
// Allan curves and noise coefficients as the commands write them.
#include <nlohmann/json.hpp>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

Json points_json(const std::vector<AllanPoint>& points) {
  auto all = Json::array();
  for (const AllanPoint& point : points)
    all.push_back({{"tau_s", point.tau},
                   {"deviation", point.deviation},
                   {"clusters", point.clusters},
                   {"interval", {point.interval.low, point.interval.high}},
                   {"freedom", point.freedom},
                   {"noise", name_of(point.noise)}});
  return all;
}

Json coefficient_json(const CoefficientEstimate& estimate, double scale,
                      const std::string& unit) {
  return {{"value", scale * estimate.value},
          {"interval",
           {scale * estimate.interval.low, scale * estimate.interval.high}},
          {"unit", unit}};
}

Json report_json(const CoefficientReport& report) {
  if (!report.per_second) return nullptr;
  const CoefficientEstimate& found = *report.per_second;
  return {{"per_second", coefficient_json(found, 1.0, report.unit_per_second)},
          {"per_hour", coefficient_json(found, report.hours_per_second_unit,
                                        report.unit_per_hour)},
          {"relative_uncertainty", found.uncertainty / found.value}};
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<DeviationSeries>& curves) {
  nlohmann::ordered_json json;
  for (const auto& [kind, points] : curves)
    json[name_of(kind)] = points_json(points);
  return json;
}

std::vector<CoefficientReport> reports(const NoiseCoefficients& c,
                                       const std::string& unit) {
  if (unit == "deg/s")
    return {
        {'Q', "angle quantisation", c.angle_quantisation, 1.0, "deg", "deg"},
        {'N', "angle random walk", c.angle_random_walk, 60.0, "deg/sqrt(s)",
         "deg/sqrt(h)"},
        {'B', "bias instability", c.bias_instability, 3600.0, "deg/s", "deg/h"},
        {'K', "rate random walk", c.rate_random_walk, 3600.0 * 60.0,
         "deg/s/sqrt(s)", "deg/h/sqrt(h)"},
        {'R', "rate ramp", c.rate_ramp, 3600.0 * 3600.0, "deg/s/s", "deg/h/h"}};
  const auto times = [&](const char* factor) { return unit + factor; };
  return {{'Q', "quantisation", c.angle_quantisation, 1.0 / 3600.0, times(" s"),
           times(" h")},
          {'N', "white noise", c.angle_random_walk, 1.0 / 60.0,
           times(" sqrt(s)"), times(" sqrt(h)")},
          {'B', "flicker", c.bias_instability, 1.0, unit, unit},
          {'K', "random walk", c.rate_random_walk, 60.0, times("/sqrt(s)"),
           times("/sqrt(h)")},
          {'R', "ramp", c.rate_ramp, 3600.0, times("/s"), times("/h")}};
}

nlohmann::ordered_json to_json(const NoiseCoefficients& coefficients,
                               const std::string& unit) {
  nlohmann::ordered_json json;
  for (const CoefficientReport& report : reports(coefficients, unit))
    json[std::string(1, report.symbol)] = report_json(report);
  json["lowest"] = {{"tau_s", coefficients.lowest.tau},
                    {"deviation", coefficients.lowest.deviation},
                    {"still_falling", coefficients.still_falling}};
  auto left_out = nlohmann::ordered_json::array();
  for (const LeftOutTau& tau : coefficients.left_out)
    left_out.push_back({{"tau_s", tau.tau}, {"deviation_over_fit", tau.ratio}});
  json["fit"] = {
      {"taus_s", coefficients.taus},
      {"left_out", left_out},
      {"misfit", coefficients.misfit},
      {"band_limit_s", coefficients.band_limit
                           ? nlohmann::ordered_json(*coefficients.band_limit)
                           : nullptr}};
  return json;
}

}  // namespace beamgyro::internal
