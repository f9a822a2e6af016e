// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "validation/evidence/evidence.h"
#include "validation/metrics/sigma_report.h"
#include "validation/result/validation_result.h"

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

/// Returns the figure of a yield, "population_" and the name: the share of the
/// devices whose metric is at most x, before and after, and the most that is
/// allowed.
nlohmann::ordered_json population_figure(const PopulationMetric& metric,
                                         const std::optional<double>& limit);

/// Returns the figures of a sigma, "sigma_pit" and "sigma_coverage".
nlohmann::ordered_json sigma_figures(const SigmaReport& report);

}  // namespace beamgyro::internal
