// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "validation/evidence/evidence.h"
#include "validation/metrics/sigma_report.h"

namespace beamgyro::internal {

/// The most points of a series of a figure.
constexpr std::size_t kFigurePoints = 300;

/// Returns the figures that the runs allow, [{"id", "title", "caption", "x":
/// {"label", "unit", "scale"}, "y", "kind", "series"}, ...]
/// (docs/guide/report.md), of the recorded rate (`before`) and of that of a
/// compensator (`after`), which have the same runs in the same order. Figures
/// have six significant digits. Throws std::invalid_argument when the two have
/// different runs, or a run has not one rate for each time.
nlohmann::ordered_json figures_of(const Evidence& before,
                                  const Evidence& after);

/// A figure of merit of each device of a population; NaN: it has none.
struct PopulationFigure {
  std::string name, unit;  // bias over temperature, peak to peak; deg/s
  std::span<const double> before, after;
  std::optional<double> limit = {};  // the most that is allowed
};

/// Returns the figure of a yield, "population_" and the name: the share of the
/// devices whose metric is at most x, before and after, and the limit.
nlohmann::ordered_json population_figure(const PopulationFigure& figure);

/// Returns the figures of a sigma, "sigma_pit" and "sigma_coverage".
nlohmann::ordered_json sigma_figures(const SigmaReport& report);

}  // namespace beamgyro::internal
