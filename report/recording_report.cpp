// SPDX-License-Identifier: MIT
#include "report/recording_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

namespace beamgyro::internal {
namespace {

struct Extent {
  double low = 0, high = 0;
  std::size_t finite = 0;
};

Extent extent(const std::vector<double>& values) {
  Extent e;
  for (const double v : values) {
    if (std::isnan(v)) continue;
    e.low = e.finite == 0 ? v : std::min(e.low, v);
    e.high = e.finite == 0 ? v : std::max(e.high, v);
    ++e.finite;
  }
  return e;
}

std::string status_line(const Recording& recording) {
  std::size_t unpowered = 0, saturated = 0, unlocked = 0;
  for (const std::uint8_t s : recording.status) {
    unpowered += (s & kUnpowered) != 0;
    saturated += (s & kOutputSaturated) != 0;
    unlocked += (s & kLoopNotLocked) != 0;
  }
  return fmt::format("{} unpowered, {} saturated, {} not locked", unpowered,
                     saturated, unlocked);
}

}  // namespace

std::string recording_report(const std::string& path,
                             const Recording& recording) {
  std::string text;
  auto out = std::back_inserter(text);
  const std::size_t count = recording.time.size();
  fmt::format_to(out, "{}: recording, {} samples", path, count);
  if (count > 0) {
    fmt::format_to(out, " from {:g} to {:g} s", recording.time.front(),
                   recording.time.back());
  }
  if (count > 1) {
    fmt::format_to(out, ", {:.6g} Hz",
                   static_cast<double>(count - 1) /
                       (recording.time.back() - recording.time.front()));
  }
  fmt::format_to(out, "\nfidelity {}, seed {}, made by beamgyro {} ({})\n",
                 recording.fidelity, recording.seed, recording.program_version,
                 recording.git_revision);
  if (!recording.compensator.empty())
    fmt::format_to(out, "compensated by {} (SHA-256 {})\n",
                   recording.compensator, recording.compensator_sha256);
  fmt::format_to(out, "samples {}\n", status_line(recording));
  if (!recording.overrides_text.empty())
    fmt::format_to(out, "overrides\n{}", recording.overrides_text);
  fmt::format_to(out, "\n{:<26} {:<10} {:<12} {:>12} {:>12}\n", "variable",
                 "units", "role", "minimum", "maximum");
  for (const Column& column : recording.columns) {
    const Extent e = extent(column.values);
    fmt::format_to(out, "{:<26} {:<10} {:<12} {:>12} {:>12}\n", column.name,
                   column.units, role_name(column.role),
                   e.finite ? fmt::format("{:.6g}", e.low) : "-",
                   e.finite ? fmt::format("{:.6g}", e.high) : "-");
  }
  return text;
}

}  // namespace beamgyro::internal
