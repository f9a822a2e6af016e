// SPDX-License-Identifier: MIT
#include "validation/page/figure.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace beamgyro::internal {
namespace {

double with_six_digits(double value) {
  if (!std::isfinite(value)) return value;
  const std::string text = fmt::format("{:.6g}", value);
  double read = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  return read == 0.0 ? 0.0 : read;  // no negative zero
}

nlohmann::ordered_json axis_json(const FigureAxis& axis) {
  return {{"label", axis.label},
          {"unit", axis.unit},
          {"scale", axis.logarithmic ? "log" : "linear"}};
}

nlohmann::ordered_json values_json(const std::vector<double>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const double value : values) json.push_back(with_six_digits(value));
  return json;
}

nlohmann::ordered_json series_json(const FigureSeries& series) {
  nlohmann::ordered_json json = {{"name", series.name}};
  if (!series.role.empty()) json["role"] = series.role;
  if (!series.kind.empty()) json["kind"] = series.kind;
  json["x"] = values_json(series.x);
  json["y"] = values_json(series.y);
  if (!series.low.empty()) {
    json["low"] = values_json(series.low);
    json["high"] = values_json(series.high);
  }
  return json;
}

/// Largest less smallest value of the series for which `counts` holds.
template <typename Counts>
double span_of_values(const Figure& figure, const Counts& counts) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const FigureSeries& series : figure.series)
    for (const double y : series.y)
      if (counts(series)) {
        low = std::min(low, y);
        high = std::max(high, y);
      }
  return high - low;
}

}  // namespace

void FigureSeries::add(double at, double value) {
  if (!std::isfinite(at) || !std::isfinite(value)) return;
  x.push_back(at);
  y.push_back(value);
}

void FigureSeries::add(double at, double value, const Interval& interval) {
  if (!std::isfinite(at) || !std::isfinite(value)) return;
  add(at, value);
  low.push_back(interval.low);
  high.push_back(interval.high);
}

void FigureSeries::add(double at, double value, double half_interval) {
  add(at, value, Interval{value - half_interval, value + half_interval});
}

void Figure::add(FigureSeries added) {
  if (!added.x.empty()) series.push_back(std::move(added));
}

nlohmann::ordered_json to_json(const Figure& figure) {
  nlohmann::ordered_json series = nlohmann::ordered_json::array();
  for (const FigureSeries& each : figure.series)
    series.push_back(series_json(each));
  return {{"id", figure.id},
          {"title", figure.title},
          {"caption", figure.caption},
          {"x", axis_json(figure.x)},
          {"y", axis_json(figure.y)},
          {"kind", figure.kind},
          {"series", std::move(series)}};
}

std::vector<Figure> close_up(const Figure& whole, const std::string& role,
                             const std::string& id_suffix,
                             const std::string& title) {
  const auto of_role = [&](const FigureSeries& series) {
    return series.role == role;
  };
  const auto any = [](const FigureSeries&) { return true; };
  // "not at least": a role without a point has an endless negative span.
  const double part = span_of_values(whole, of_role);
  if (!(part >= 0.0 && part <= 0.5 * span_of_values(whole, any))) return {};
  Figure closer = whole;
  closer.id += id_suffix;
  closer.title = title;
  std::erase_if(closer.series,
                [&](const FigureSeries& series) { return !of_role(series); });
  return {std::move(closer)};
}

}  // namespace beamgyro::internal
