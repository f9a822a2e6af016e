// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "compensation/inputs/input.h"
#include "compensation/methods/method_list.h"
#include "compensation/models/lookup_table.h"
#include "compensation/rows/row_groups.h"
#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Returns the root of the mean of `squares` near each temperature of `at`:
/// weights exp(-(T - T_k)^2 / 2 w^2), w an eighth of the span of T, and beside
/// them the mean of all with the weight of a tenth of the points.
Eigen::ArrayXd local_rms(const Eigen::Ref<const Eigen::ArrayXd>& T,
                         const Eigen::Ref<const Eigen::ArrayXd>& squares,
                         const Eigen::ArrayXd& at);

/// Returns groups of consecutive rows of a power cycle whose temperature stays
/// within kPointWidth of the first: soaks, and stretches of ramps.
RowGroups soak_groups(const TrainingRows& rows);

struct LeftOutSigma {
  LookupTable sigma;  // [deg/s]
  int groups;         // that were left out
};

/// Returns the 1-sigma of the prediction of a new group of rows by a fit that
/// is linear in the bias (a polynomial or a spline). Each of soak_groups() is
/// predicted by a fit to the others; of its mean residual d,
///
///   s(T)^2 = local_rms(d^2)(T)^2 (1 + h(T)) / (1 + mean h),
///   h(T) = sum over groups of (db(T) / d bias of the group)^2:
///
/// the covariance of the fit to groups of equal and independent noise. Groups
/// beyond the temperatures of the others do not count. With more than
/// kMostLeftOut groups, every kMostLeftOut-th is left out together, and h is 0.
/// Throws UndeterminedFit where three groups cannot be predicted by the others.
constexpr int kMostLeftOut = 40;
LeftOutSigma left_out_sigma(const FitSpec& kind,
                            const std::vector<Input>& inputs,
                            const TrainingRows& rows, const Eigen::ArrayXd& at,
                            std::uint64_t seed);

}  // namespace beamgyro::internal
