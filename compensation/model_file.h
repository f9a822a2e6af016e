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
#include "compensation/population.h"
#include "compensation/row_options.h"
#include "config/document.h"

namespace beamgyro {

struct NoneSpec {};
struct ConstantSpec {};

/// Table [polynomial].
struct PolynomialSpec {
  int degree = 3;  // 0 ... 12
  // false: powers of T - 25 degC in kelvins by the normal equations
  bool normalised = true;
};

/// Table [table].
struct TableSpec {
  double bin_width_K = 5.0;  // [K], > 0
};

/// Table [spline].
struct SplineSpec {
  double knot_spacing_K = 5.0;  // [K], see spline_knots()
  SplineEnd end = SplineEnd::kNotAKnot;
};

struct Px4Spec {};

/// Table [ardupilot].
struct ArduPilotSpec {
  int least_samples = 100;  // of a point, >= 1
};

/// Table [thermistor].
struct ThermistorSpec {
  double b_K = 3950.0;  // [K], > 0
};

/// Table [fuzzy].
struct FuzzySpec {
  int rules = 8;  // >= 2
};

/// Table [bp].
struct BpSpec {
  std::vector<int> hidden;      // neurons of each hidden layer
  double goal_deg_per_s = 0.0;  // [deg/s], becomes TrainOptions::goal
  std::vector<double> weight_decays = {0.0};  // best_network() chooses
  TrainOptions training;
};

/// Table [population].
struct PopulationSpec {
  double grid_K = 5.0;  // [K], > 0
};

/// Table [adapted].
struct AdaptedSpec {
  Population population;
  std::string source;  // of it, for the provenance
  PointNoise noise;
};

using FitSpec = std::variant<NoneSpec, ConstantSpec, PolynomialSpec, TableSpec,
                             SplineSpec, Px4Spec, ArduPilotSpec, ThermistorSpec,
                             FuzzySpec, BpSpec, PopulationSpec, AdaptedSpec>;

/// One of the models of an automatic choice.
struct Candidate {
  std::string name;  // as the model file says it
  std::vector<Input> inputs;
  FitSpec kind;
};

/// The contents of a model file: what to train.
struct ModelSpec {
  std::vector<Input> inputs = {};
  RowOptions rows = {};
  FitSpec kind = {};
  std::vector<Candidate> candidates = {};  // simplest first; empty = `kind`
  std::optional<double> scale_factor_bin_K = {};  // [scale_factor], > 0
  std::string text = {};                          // model file as read
  std::vector<std::filesystem::path> files = {};  // all that was read
};

/// Reads a model file (docs/reference/model_file.md). Throws
/// std::invalid_argument with file, line and column for a key, type or value
/// that is not allowed, an unknown key, or inputs the kind of model cannot
/// take; of an adapted model also for the file of its population, whose name is
/// relative to the model file.
ModelSpec read_model(const std::filesystem::path& file);
ModelSpec read_model(const ConfigDocument& document);

}  // namespace beamgyro
