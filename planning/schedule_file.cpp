// SPDX-License-Identifier: MIT
#include "planning/schedule_file.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "config/config_node.h"

namespace beamgyro::internal {
namespace {

std::string toml_string(const std::string& text) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kText;
  node.text = text;
  return toml_text(node);
}

}  // namespace

std::string clock_time(double seconds) {
  const auto minutes = std::lround(seconds / 60.0);
  return fmt::format("{}:{:02}", minutes / 60, minutes % 60);
}

std::string soak_count(std::size_t count) {
  return fmt::format("{} soak{}", count, count == 1 ? "" : "s");
}

std::string rule_text(const RowRule& rule) {
  return fmt::format(
      "rows = {{ steady_K_per_min = {:g}, lag_min = {:g}{} }}", rule.steady,
      rule.lag,
      rule.after_power_on > 0.0
          ? fmt::format(", after_power_on_min = {:g}", rule.after_power_on)
          : "");
}

std::string schedule_text(const std::vector<double>& soaks,
                          const ChamberTime& time, const RowRule& rule,
                          const std::string& device) {
  const std::vector<Visit> stops = visits(soaks, time);
  std::string text = fmt::format(
      "# A calibration planned from a population: {}, {:.2f} h.\n"
      "# Chamber at {:g} degC, power on at 0:00, ramps of {:g} K/min.\n"
      "# To be trained on with {}.\n",
      soak_count(stops.size()), chamber_hours(soaks, time), time.start,
      time.ramp, rule_text(rule));
  auto out = std::back_inserter(text);
  std::string points = fmt::format("  [0, {}],\n", time.start);
  for (const Visit& stop : stops) {
    fmt::format_to(out, "#   {:>5} to {:>5}  hold {:g} degC\n",
                   clock_time(stop.begin), clock_time(stop.end),
                   stop.temperature);
    if (stop.begin > 0.0)
      points += fmt::format("  [{:.10g}, {}],\n", stop.begin, stop.temperature);
    points += fmt::format("  [{:.10g}, {}],\n", stop.end, stop.temperature);
  }
  fmt::format_to(out,
                 "name = \"planned_soaks\"\n"
                 "description = \"a calibration at {} planned temperatures\"\n"
                 "device = {}\n"
                 "fidelity = \"quasistatic\"\n"
                 "duration_s = {:.0f}\n"
                 "output_rate_Hz = 0.1\n"
                 "seed = 0\n\n"
                 "[ambient]\npoints = [\n{}]\n\n"
                 "[chamber]\nstirred = true\n",
                 stops.size(), toml_string(device), std::ceil(stops.back().end),
                 points);
  return text;
}

}  // namespace beamgyro::internal
