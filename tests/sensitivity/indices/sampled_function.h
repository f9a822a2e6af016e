// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "sensitivity/indices/pick_freeze.h"

namespace beamgyro::internal {

/// A function of independent numbers that are uniform on (0, 1).
using UnitFunction = std::function<double(const std::vector<double>&)>;

/// f = sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, each x uniform on (-pi, pi)
/// (Ishigami and Homma, 1990).
double ishigami(const std::vector<double>& u);

/// f = product of (|4 u_i - 2| + a_i) / (1 + a_i) (Saltelli and Sobol', 1995).
double g_function(const std::vector<double>& u);
inline const std::vector<double> kGImportance = {0, 1, 4.5, 9, 99, 99, 99, 99};

/// f at scrambled Sobol' points of 2 n dimensions.
PickFreezeValues sampled(const UnitFunction& f, std::size_t dimensions,
                         std::size_t rows, std::uint64_t seed);

/// f at independent random points, and these, one row for each.
struct IndependentSample {
  std::vector<double> values;
  Eigen::MatrixXd numbers;
};
IndependentSample independent_sample(const UnitFunction& f,
                                     std::size_t dimensions, std::size_t rows,
                                     std::uint64_t seed);

}  // namespace beamgyro::internal
