// SPDX-License-Identifier: MIT
#include "report/allan_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace beamgyro::internal {
namespace {

std::string interval_text(const ConfidenceInterval& interval) {
  return fmt::format("{:.4g} to {:.4g}", interval.low, interval.high);
}

}  // namespace

std::string series_line(const EvenSeries& series) {
  return fmt::format(
      "{} samples at {:g} Hz from {:g} to {:g} s, {} stretch{}, {} missing "
      "between them, {} left out\n",
      series.samples, 1.0 / series.interval, series.first, series.last,
      series.stretches.size(), series.stretches.size() == 1 ? "" : "es",
      series.missing, series.left_out);
}

std::string deviation_table(const std::vector<DeviationSeries>& curves,
                            const std::string& unit) {
  std::string text = fmt::format("{:>12}", "tau s");
  auto out = std::back_inserter(text);
  std::map<double, std::vector<const AllanPoint*>> rows;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    fmt::format_to(out, " {:>14}", name_of(curves[c].kind) + " " + unit);
    for (const AllanPoint& point : curves[c].points) {
      auto& row = rows[point.tau];
      row.resize(curves.size());
      row[c] = &point;
    }
  }
  fmt::format_to(out, " {:>10} {:>25}  noise\n", "clusters",
                 "95 % of " + name_of(curves.back().kind));
  for (const auto& [tau, points] : rows) {
    fmt::format_to(out, "{:>12.6g}", tau);
    for (const AllanPoint* point : points)
      text += point != nullptr ? fmt::format(" {:>14.6g}", point->deviation)
                               : fmt::format(" {:>14}", "-");
    const AllanPoint& some = **std::ranges::find_if(
        points, [](const AllanPoint* point) { return point != nullptr; });
    const AllanPoint* last = points.back();
    fmt::format_to(out, " {:>10} {:>25}  {}\n", some.clusters,
                   last != nullptr ? interval_text(last->interval) : "-",
                   name_of(some.noise));
  }
  return text;
}

std::string noise_table(const NoiseCoefficients& found,
                        const std::string& unit) {
  std::string text = fmt::format("{:<22}{:>12} {:<15} {}\n", "coefficient", "",
                                 "unit", "95 %");
  auto out = std::back_inserter(text);
  for (const CoefficientReport& report : reports(found, unit)) {
    const std::string name = fmt::format("{} {}", report.name, report.symbol);
    if (!report.per_second) {
      fmt::format_to(out, "{:<22}{:>12}\n", name, "-");
      continue;
    }
    const auto& estimate = *report.per_second;
    const auto line = [&](const std::string& first, double scale,
                          const std::string& of) {
      fmt::format_to(out, "{:<22}{:>12.4g} {:<15} {}\n", first,
                     estimate.value * scale, of,
                     interval_text({estimate.interval.low * scale,
                                    estimate.interval.high * scale}));
    };
    line(name, report.hours_per_second_unit, report.unit_per_hour);
    line("", 1.0, report.unit_per_second);
  }
  fmt::format_to(out, "{:<22}{:>12.4g} {} at {:g} s{}\n", "lowest deviation",
                 found.lowest.deviation, unit, found.lowest.tau,
                 found.still_falling ? ", still falling" : "");
  fmt::format_to(out, "fitted to {} taus, {:g} to {:g} s; the misfit is ",
                 found.taus.size(), found.taus.front(), found.taus.back());
  text += found.misfit > 0.0
              ? fmt::format("{:.2g} % beyond chance\n", 100 * found.misfit)
              : "no more than chance\n";
  for (const LeftOutTau& tau : found.left_out)
    fmt::format_to(out, "left out: {:g} s, {} of the fit\n", tau.tau,
                   std::isfinite(tau.ratio) ? fmt::format("{:.3g}", tau.ratio)
                                            : "nothing");
  if (found.band_limit)
    fmt::format_to(out,
                   "band of the white noise limited as by a pole of {:.3g} s\n",
                   *found.band_limit);
  return text;
}

}  // namespace beamgyro::internal
