// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "validation/metrics/metric.h"

namespace beamgyro::internal {

/// Returns the evaluation by a function that needs more than the evidence.
template <class... Arguments>
Evaluation given(std::optional<Estimate> (*function)(const Evidence&,
                                                     Arguments...),
                 std::type_identity_t<Arguments>... arguments) {
  return [=](const Evidence& evidence) {
    return function(evidence, arguments...);
  };
}

/// The rows of each subject, in the order of reports.
std::vector<Metric> temperature_metrics();
std::vector<Metric> residual_metrics();
std::vector<Metric> hysteresis_metrics();
std::vector<Metric> start_metrics();
std::vector<Metric> scale_factor_metrics();
std::vector<Metric> noise_metrics();
std::vector<Metric> response_metrics();
std::vector<Metric> motion_metrics();
/// Of the sigma that a compensator states for its rate.
std::vector<Metric> sigma_metrics();

}  // namespace beamgyro::internal
