// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compensation/cubic_spline.h"
#include "compensation/input.h"
#include "compensation/network_training.h"
#include "config/document.h"

namespace beamgyro {

/// Table [rows]: how samples become training rows.
struct RowOptions {
  double seconds = 60.0;  // [s], length of the blocks that are averaged, > 0
  // [K/min]; rows whose temperature changes faster are left out
  std::optional<double> steady_K_per_min;
};

/// Table [polynomial].
struct PolynomialSpec {
  int degree = 3;  // 0 ... 12
};

/// Table [spline].
struct SplineSpec {
  double knot_spacing_K = 5.0;  // [K], see spline_knots()
  SplineEnd end = SplineEnd::kNotAKnot;
};

/// Table [bp].
struct BpSpec {
  std::vector<int> hidden;      // neurons of each hidden layer
  double goal_deg_per_s = 0.0;  // [deg/s], becomes TrainOptions::goal
  TrainOptions training;
};

/// What to train, as a model file says it.
struct ModelSpec {
  std::vector<Input> inputs;
  RowOptions rows;
  std::variant<PolynomialSpec, SplineSpec, BpSpec> kind;
  std::string text;  // model file byte for byte as read
};

/// Reads a model file (docs/formats.md). Throws std::invalid_argument with
/// file, line and column for a key, type or value that is not allowed, an
/// unknown key, or inputs the kind of model cannot take.
ModelSpec read_model(const std::filesystem::path& file);
ModelSpec read_model(const ConfigDocument& document);

}  // namespace beamgyro
