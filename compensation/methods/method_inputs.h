// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/method.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// The inputs that the key `inputs` of a model file names. Throws as
/// ConfigTable for none, for a name that is not an input and for one that is
/// there twice.
std::vector<Input> read_inputs(const ConfigTable& root);

/// The inputs that a compensator file names. Throws as JsonNode.
std::vector<Input> read_inputs(const JsonNode& node);

/// Throws as ConfigTable for inputs that the rule forbids; `method` is its name
/// in the message.
void check_inputs(const ConfigTable& root, const std::vector<Input>& inputs,
                  InputRule rule, const std::string& method);

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
/// Temperatures closer than this are one temperature to a polynomial.
constexpr double kDistinctTemperatures = 1.0;  // [K]

/// Returns how many temperatures there are so far apart [K], from the lowest
/// on.
int distinct_temperatures(const Eigen::ArrayXd& temperature,
                          double apart = kDistinctTemperatures);

}  // namespace beamgyro::internal
