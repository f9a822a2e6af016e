// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/inputs/input.h"
#include "compensation/methods/method_list.h"
#include "compensation/methods/population.h"
#include "compensation/models/lookup_table.h"
#include "compensation/rows/row_groups.h"
#include "compensation/rows/training_rows.h"
#include "compensation/training/sigma_residuals.h"

namespace beamgyro::internal {

/// Kind of group of a sigma that no run calibrated, in SigmaCalibration.
constexpr const char* kLeftOutGroup = "soak";

/// Whether the sigma of a method can be told at all: not that of constants, a
/// thermistor or fits of autopilots.
bool may_state_sigma(const FitSpec& kind);

/// Returns the sigma of `trained`, or nothing where its method cannot tell one,
/// nor where the data cannot, with the reason in `why_none`.
/// - Of a population and of an adapted device s(T) is the posterior deviation
///   (population_sigma(), adapted_sigma()). Held-out devices or runs calibrate
///   it from two on (calibrate()); an adapted device takes the calibration of
///   its population until they are kLeastConformalGroups.
/// - Of others s(T) is the root mean square near T of the residuals of held-out
///   runs, power cycles or legs, whichever gives two groups first. Without
///   held-out runs those of groups_to_leave_out() take their place: of a
///   polynomial or a spline always, of others where cross-validation was asked
///   for.
/// - Of a polynomial and a spline of rows without such groups s(T) is that of
///   left_out_sigma(), where two held-out groups or more calibrate it. One run
///   does not tell how the next one differs: its soaks share a turn-on offset.
/// The runs concerned are visited once more.
std::optional<BiasSigma> fit_bias_sigma(const FittedCompensator& trained,
                                        const SigmaTask& task,
                                        std::string& why_none);

/// Returns adaptation_sigma() of a population that was just learned, on the
/// held-out devices, or nothing without a set of these. Devices that it leaves
/// out are told in `remarks`.
std::optional<AdaptationSigma> fit_adaptation_sigma(
    const Population& population, const LookupTable* scale_factor,
    const SigmaTask& task, std::vector<std::string>& remarks);

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
