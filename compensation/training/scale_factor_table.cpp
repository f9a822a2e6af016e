// SPDX-License-Identifier: MIT
#include "compensation/training/scale_factor_table.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "compensation/scoring/scale_factor.h"

namespace beamgyro::internal {

LookupTable fit_scale_factor(const RunSource& runs, double bin_width) {
  struct Bin {
    double temperature = 0.0, raw = 0.0, truth = 0.0;
  };
  std::map<double, Bin> bins;
  runs.for_each([&](const TrainingRun& run) {
    for (const PlateauSlope& slope :
         plateau_slopes(run.recording, kTableRate)) {
      Bin& bin = bins[std::floor(slope.temperature / bin_width)];
      bin.temperature += slope.truth * slope.temperature;
      bin.raw += slope.raw;
      bin.truth += slope.truth;
    }
  });
  if (bins.empty())
    throw std::invalid_argument(fmt::format(
        "a scale-factor table needs recordings whose true rate varies by {} "
        "deg/s at a steady temperature; none of the {} does",
        kTableRate, runs.count));
  LookupTable table{Eigen::ArrayXd(static_cast<Eigen::Index>(bins.size())),
                    Eigen::ArrayXd(static_cast<Eigen::Index>(bins.size()))};
  Eigen::Index k = 0;
  for (const auto& [number, bin] : bins) {
    table.temperatures(k) = bin.temperature / bin.truth;
    table.values(k++) = bin.raw / bin.truth;
  }
  return table;
}

}  // namespace beamgyro::internal
