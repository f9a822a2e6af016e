// SPDX-License-Identifier: MIT
#include "planning/schedule_file.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace beamgyro::internal {
namespace {

// A basic string of TOML.
std::string toml_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f)
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
    else
      quoted += letter;
  }
  return quoted + "\"";
}

std::string clock_time(double seconds) {
  const auto minutes = std::lround(seconds / 60.0);
  return fmt::format("{}:{:02}", minutes / 60, minutes % 60);
}

}  // namespace

std::string schedule_text(const std::vector<double>& soaks,
                          const ChamberTime& time, const std::string& device) {
  const std::vector<Visit> stops = visits(soaks, time);
  std::string text = fmt::format(
      "# A calibration planned from a population: {} soak{}, {:.2f} h.\n"
      "# Chamber at {:g} degC, power on at 0:00, ramps of {:g} K/min.\n",
      stops.size(), stops.size() == 1 ? "" : "s", chamber_hours(soaks, time),
      time.start, time.ramp);
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
