// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "statistics/curve_family.h"

namespace beamgyro::internal {

/// Curves that were described, and what was done to them before.
struct DescribedCurves {
  std::string name;                      // of the campaign
  std::span<const std::uint32_t> units;  // their numbers
  CurveFamily family;                    // treated, [degC] and [deg/s]
  std::optional<double> zero_at;         // [degC]
  std::optional<double> round_to;        // [deg/s]
  std::vector<CurveFigures> figures;     // of each unit
  CurveModes modes;
};

/// Returns what the curves are, and a table of their figures.
std::string curve_text(const DescribedCurves& described);

/// {"curves", "units", "flat", "range_degC", "temperatures", "zero_at_degC",
/// "round_deg_per_s", "figures": {NAME: {"unit", "p05", "median", "p95",
/// "values"}, ...}, "pp_log10_sigma", "component_shares", "mean_curve_share"}
nlohmann::ordered_json curve_json(const DescribedCurves& described);

}  // namespace beamgyro::internal
