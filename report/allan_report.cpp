// SPDX-License-Identifier: MIT
#include "report/allan_report.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace beamgyro {

std::string series_line(const EvenSeries& series) {
  return fmt::format(
      "{} samples at {:g} Hz from {:g} to {:g} s, {} stretch{}, {} missing "
      "between them, {} left out\n",
      series.samples, 1.0 / series.interval, series.first, series.last,
      series.stretches.size(), series.stretches.size() == 1 ? "" : "es",
      series.missing, series.left_out);
}

std::string allan_table(const AllanCurve& curve, const std::string& unit) {
  std::string text =
      fmt::format("{:>12} {:>14} {:>14} {:>10} {:>8}\n", "tau s",
                  "adev " + unit, "oadev " + unit, "clusters", "+-%");
  for (std::size_t i = 0; i < curve.plain.size(); ++i) {
    const AllanPoint& plain = curve.plain[i];
    const AllanPoint& overlapping = curve.overlapping[i];
    const bool known = plain.clusters > 1;
    fmt::format_to(
        std::back_inserter(text),
        "{:>12.6g} {:>14.6g} {:>14.6g} {:>10} {:>8}\n", plain.tau,
        plain.deviation, overlapping.deviation, plain.clusters,
        known ? fmt::format("{:.1f}", 100 * relative_uncertainty(overlapping))
              : "-");
  }
  return text;
}

std::string noise_table(const NoiseCoefficients& found,
                        const std::string& unit) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const CoefficientReport& report : reports(found, unit)) {
    const std::string name = fmt::format("{} {}", report.name, report.symbol);
    if (!report.per_second) {
      fmt::format_to(out, "{:<22}{:>12}\n", name, "-");
      continue;
    }
    const auto [value, uncertainty] = *report.per_second;
    fmt::format_to(out, "{:<22}{:>12.4g} {:<14} {:.4g} {}, +- {:.1f} %\n", name,
                   value * report.hours_per_second_unit, report.unit_per_hour,
                   value, report.unit_per_second, 100 * uncertainty / value);
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

}  // namespace beamgyro
