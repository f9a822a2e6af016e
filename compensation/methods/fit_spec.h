// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "compensation/methods/population.h"
#include "compensation/models/cubic_spline.h"
#include "compensation/network/network_training.h"

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

}  // namespace beamgyro
