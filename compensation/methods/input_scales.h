// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/method.h"

namespace beamgyro::internal {

/// Scales that leave the inputs as they are.
std::vector<Scale> unscaled(const FitTask& task);

/// Scales that take each input to [-1, 1]. Throws as scale_to_unit().
std::vector<Scale> scales_of(const FitTask& task);

/// The inputs, each by its scale.
Eigen::ArrayXXd scaled(const Eigen::ArrayXXd& inputs,
                       const std::vector<Scale>& scales);

/// The measured temperature as the first input has it [degC].
inline Eigen::ArrayXd first_input(const FitTask& task) {
  return task.rows.inputs.col(0);
}

/// Throws std::invalid_argument when the temperatures are too few for a
/// polynomial of that degree: those less than 1 K apart count as one.
void check_temperatures(const Eigen::ArrayXd& temperature, int degree);
int distinct_temperatures(const Eigen::ArrayXd& temperature);

}  // namespace beamgyro::internal
