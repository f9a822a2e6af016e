// SPDX-License-Identifier: MIT
#include "report/curve_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "statistics/intervals.h"

namespace beamgyro::internal {
namespace {

/// A figure of each unit, as it is reported.
struct ReportedFigure {
  const char *name, *unit, *words;
  double (*of)(const CurveFigures&);
};

constexpr ReportedFigure kReported[] = {
    {"pp_deg_per_s", "deg/s", "peak to peak",
     [](const CurveFigures& one) { return one.peak_to_peak; }},
    {"left_by_line", "1", "share of variance left by a line",
     [](const CurveFigures& one) { return one.left[0]; }},
    {"left_by_cubic", "1", "share left by a cubic",
     [](const CurveFigures& one) { return one.left[1]; }},
    {"left_by_quintic", "1", "share left by a quintic",
     [](const CurveFigures& one) { return one.left[2]; }},
    {"kink", "1", "largest bend over 3 K / peak to peak",
     [](const CurveFigures& one) { return one.kink; }},
};

std::vector<double> values_of(const DescribedCurves& described,
                              const ReportedFigure& figure) {
  std::vector<double> values;
  for (const CurveFigures& one : described.figures)
    values.push_back(figure.of(one));
  return values;
}

/// Returns 5, 50 and 95 % of the values that are there, or nothing.
std::optional<std::array<double, 3>> quantiles_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return {};
  std::ranges::sort(values);
  return std::array{percentile(values, 0.05), percentile(values, 0.5),
                    percentile(values, 0.95)};
}

/// Returns the standard deviation of log10 of the peaks to peaks above 0, of
/// two or more units.
std::optional<double> log10_sigma(const DescribedCurves& described) {
  double sum = 0, squares = 0, count = 0;
  for (const CurveFigures& one : described.figures)
    if (one.peak_to_peak > 0) {
      sum += std::log10(one.peak_to_peak);
      ++count;
    }
  if (count < 2) return {};
  for (const CurveFigures& one : described.figures)
    if (one.peak_to_peak > 0)
      squares += std::pow(std::log10(one.peak_to_peak) - sum / count, 2);
  return std::sqrt(squares / (count - 1));
}

std::ptrdiff_t flat_units(const DescribedCurves& described) {
  return std::ranges::count_if(described.figures, [](const CurveFigures& one) {
    return one.peak_to_peak == 0;
  });
}

std::string head_line(const DescribedCurves& described) {
  const Eigen::VectorXd& T = described.family.temperature;
  std::string text = fmt::format(
      "{}: {} {}, {:g} to {:g} degC, {} temperatures", described.name,
      described.units.size(), described.units.size() == 1 ? "unit" : "units",
      T(0), T(T.size() - 1), T.size());
  if (described.zero_at)
    text += fmt::format(", zero at {:g} degC", *described.zero_at);
  if (described.round_to)
    text += fmt::format(", rounded to {:g} deg/s", *described.round_to);
  return text + '\n';
}

nlohmann::ordered_json number_or_null(double value) {
  if (std::isfinite(value)) return value;
  return nullptr;
}

nlohmann::ordered_json number_or_null(std::optional<double> value) {
  if (value) return *value;
  return nullptr;
}

nlohmann::ordered_json figure_json(const DescribedCurves& described,
                                   const ReportedFigure& figure) {
  const std::vector<double> values = values_of(described, figure);
  const auto quantiles = quantiles_of(values);
  nlohmann::ordered_json json = {{"unit", figure.unit},
                                 {"p05", nullptr},
                                 {"median", nullptr},
                                 {"p95", nullptr},
                                 {"values", nlohmann::ordered_json::array()}};
  if (quantiles) {
    json["p05"] = (*quantiles)[0];
    json["median"] = (*quantiles)[1];
    json["p95"] = (*quantiles)[2];
  }
  for (const double value : values)
    json["values"].push_back(number_or_null(value));
  return json;
}

}  // namespace

std::string curve_text(const DescribedCurves& described) {
  std::string text = head_line(described);
  text += fmt::format("{:<37}{:>8}{:>10}{:>10}\n", "", "5 %", "median", "95 %");
  for (const ReportedFigure& figure : kReported) {
    const auto quantiles = quantiles_of(values_of(described, figure));
    const std::string words =
        figure.unit == std::string_view("1")
            ? figure.words
            : fmt::format("{} [{}]", figure.words, figure.unit);
    text +=
        quantiles
            ? fmt::format("{:<37}{:>8.3g}{:>10.3g}{:>10.3g}\n", words,
                          (*quantiles)[0], (*quantiles)[1], (*quantiles)[2])
            : fmt::format("{:<37}{:>8}{:>10}{:>10}\n", words, "-", "-", "-");
  }
  if (const auto sigma = log10_sigma(described))
    text += fmt::format("standard deviation of log10 peak to peak: {:.2f}\n",
                        *sigma);
  std::vector<std::string> shares;
  for (const double share : described.modes.component_shares)
    shares.push_back(fmt::format("{:.0f}", 100 * share));
  if (!shares.empty())
    text += fmt::format("principal components: {} % of what differs\n",
                        fmt::join(shares, ", "));
  if (std::isfinite(described.modes.mean_curve_share))
    text += fmt::format("mean curve: {:.0f} % of the variance\n",
                        100 * described.modes.mean_curve_share);
  if (const auto flat = flat_units(described); flat > 0)
    text +=
        fmt::format("flat: {} of {} units, which have no shares and no bend\n",
                    flat, described.units.size());
  return text;
}

nlohmann::ordered_json curve_json(const DescribedCurves& described) {
  const Eigen::VectorXd& T = described.family.temperature;
  nlohmann::ordered_json figures = nlohmann::ordered_json::object();
  for (const ReportedFigure& figure : kReported)
    figures[figure.name] = figure_json(described, figure);
  return {
      {"curves", described.name},
      {"units", described.units},
      {"flat", flat_units(described)},
      {"range_degC", {T(0), T(T.size() - 1)}},
      {"temperatures", T.size()},
      {"zero_at_degC", number_or_null(described.zero_at)},
      {"round_deg_per_s", number_or_null(described.round_to)},
      {"figures", figures},
      {"pp_log10_sigma", number_or_null(log10_sigma(described))},
      {"component_shares", described.modes.component_shares},
      {"mean_curve_share", number_or_null(described.modes.mean_curve_share)}};
}

}  // namespace beamgyro::internal
