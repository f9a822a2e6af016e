// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "validation/metrics/metric.h"

namespace beamgyro::internal {

struct FigureAxis {
  std::string label, unit;
  bool logarithmic = false;
};

/// A curve, points or bars of a figure.
struct FigureSeries {
  std::string name;
  std::string role;  // "before", "after", "fit", "limit", or "" for none
  std::vector<double> x = {}, y = {};
  std::vector<double> low = {}, high = {};  // 95 % interval of y, or empty
  std::string kind = {};                    // as Figure::kind; empty: that

  void add(double at, double value);
  void add(double at, double value, const Interval& interval);
  void add(double at, double value, double half_interval);
};

/// A figure of a report, before anything is said about its looks.
struct Figure {
  std::string id, title, caption;
  FigureAxis x, y;
  std::string kind = "line";  // "line", "points", "bars"
  std::vector<FigureSeries> series = {};

  /// Adds a series that has a point.
  void add(FigureSeries added);
};

/// Returns the figure in JSON (figures_of()), numbers with six significant
/// digits.
nlohmann::ordered_json to_json(const Figure& figure);

/// Returns the figure with the series of one role only, as a figure of its own
/// that adds `id_suffix` to the id, or nothing when it would show little more
/// than the whole: when its values span more than half of those of the whole.
std::vector<Figure> close_up(const Figure& whole, const std::string& role,
                             const std::string& id_suffix,
                             const std::string& title);

}  // namespace beamgyro::internal
