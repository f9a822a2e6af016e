// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "api/checked_number.h"
#include "api/curve_treatment.h"
#include "config/option_message.h"
#include "dataset/files/json_text.h"
#include "include/beamgyro/curves.h"
#include "report/curve_report.h"
#include "statistics/area_metric.h"
#include "statistics/curve_family.h"

namespace beamgyro {
namespace internal {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void require_finite_values(std::span<const double> values, const char* name) {
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      throw std::invalid_argument(fmt::format(
          "{}: value {} is {}; expected finite numbers", name, k, values[k]));
}

void require_rising_temperatures(std::span<const double> temperatures) {
  for (std::size_t k = 1; k < temperatures.size(); ++k)
    if (!(temperatures[k] > temperatures[k - 1]))
      throw option_error(
          "{}: {:g} degC after {:g}; expected temperatures that increase, for "
          "figures",
          NamedOption{"beam_temperature"}, temperatures[k],
          temperatures[k - 1]);
}

void require_sample(std::span<const double> sample, std::size_t fewest) {
  if (sample.size() < fewest)
    throw std::invalid_argument(fmt::format(
        "sample: {} values; expected {} or more", sample.size(), fewest));
  require_finite_values(sample, "sample");
}

std::pair<double, double> counted_range(const CurveTreatment& treatment) {
  return {treatment.lowest_degC.value_or(-kInfinite),
          treatment.highest_degC.value_or(kInfinite)};
}

CurveFamily treated(CurveFamily family, const CurveTreatment& treatment) {
  if (treatment.zero_at_degC)
    family = zeroed_at(family, *treatment.zero_at_degC);
  const auto [low, high] = counted_range(treatment);
  family = within(family, low, high);
  return treatment.round_deg_per_s
             ? rounded_to(family, *treatment.round_deg_per_s)
             : family;
}

}  // namespace

void check_treatment(std::span<const double> temperatures,
                     const CurveTreatment& treatment) {
  require_finite_values(temperatures, "temperatures");
  require_rising_temperatures(temperatures);
  const std::pair<double, double> ends = counted_range(treatment);
  const double low = ends.first, high = ends.second;
  const auto text = fmt::format("{:g}:{:g}", low, high);
  if (!(low < high))
    throw option_error("{}: not a range; expected LOW below HIGH",
                       NamedOption{"range_degC", text});
  const auto count = std::ranges::count_if(
      temperatures, [&](double T) { return low <= T && T <= high; });
  if (count < kFewestTemperatures)
    throw option_error(
        "{}: {} temperatures to describe curves by; expected {} or more",
        NamedOption{"range_degC", text}, count, kFewestTemperatures);
  if (treatment.zero_at_degC &&
      !Range{temperatures.front(), temperatures.back()}.contains(
          *treatment.zero_at_degC))
    throw option_error(
        "{}: beyond the curves; expected a temperature from {:g} to {:g} degC",
        NamedOption{"zero_at_degC",
                    fmt::format("{:g}", *treatment.zero_at_degC)},
        temperatures.front(), temperatures.back());
  check_number("round_deg_per_s", treatment.round_deg_per_s,
               {0, std::numeric_limits<double>::max(), true, false});
}

}  // namespace internal

CurveFigureResult curve_figures(std::span<const double> temperatures_degC,
                                std::span<const double> curves,
                                std::span<const std::uint32_t> units,
                                const CurveTreatment& treatment,
                                const std::string& name) {
  using RowMajor = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
  if (units.empty() || curves.size() != units.size() * temperatures_degC.size())
    throw std::invalid_argument(fmt::format(
        "curves: {} values of {} units over {} temperatures; expected a value "
        "for each temperature of one unit or more",
        curves.size(), units.size(), temperatures_degC.size()));
  internal::require_finite_values(curves, "curves");
  internal::check_treatment(temperatures_degC, treatment);
  const auto rows = static_cast<Eigen::Index>(units.size());
  const auto columns = static_cast<Eigen::Index>(temperatures_degC.size());
  internal::DescribedCurves described;
  described.name = name;
  described.units = units;
  described.family = internal::treated(
      {Eigen::Map<const Eigen::VectorXd>(temperatures_degC.data(), columns),
       Eigen::Map<const RowMajor>(curves.data(), rows, columns)},
      treatment);
  described.zero_at = treatment.zero_at_degC;
  described.round_to = treatment.round_deg_per_s;
  described.figures = internal::curve_figures(described.family);
  described.modes = internal::curve_modes(described.family);
  return {internal::curve_text(described),
          internal::json_text(internal::curve_json(described))};
}

double area_metric(std::span<const double> one, std::span<const double> other) {
  internal::require_sample(one, 1);
  internal::require_sample(other, 1);
  return internal::area_metric(one, other);
}

double area_metric_of_table(std::span<const double> sample,
                            std::span<const double> shares,
                            std::span<const double> values) {
  internal::require_sample(sample, 1);
  internal::require_finite_values(values, "values");
  if (shares.size() < 2 || shares.size() != values.size())
    throw std::invalid_argument(fmt::format(
        "shares: {} with {} values; expected two or more, and as many values",
        shares.size(), values.size()));
  if (!(shares.front() >= 0 && shares.back() <= 1) ||
      std::ranges::adjacent_find(shares, std::not_fn(std::less())) !=
          shares.end())
    throw std::invalid_argument(
        "shares: do not increase within 0 to 1; expected shares that do");
  if (!std::ranges::is_sorted(values))
    throw std::invalid_argument(
        "values: fall from one share to the next; expected quantiles");
  return internal::area_metric(sample, {shares, values});
}

HalfSplitDistance half_split(std::span<const double> sample, std::size_t draws,
                             std::uint64_t seed) {
  internal::require_sample(sample, 2);
  if (draws < 1 || draws > 1000000)
    throw std::invalid_argument(
        fmt::format("draws: {}; expected 1 to 1000000", draws));
  const internal::HalfSplit found = internal::half_split(sample, draws, seed);
  return {found.median, found.p95};
}

}  // namespace beamgyro
