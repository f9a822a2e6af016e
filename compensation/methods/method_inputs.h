// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/methods/method.h"

namespace beamgyro::internal {

/// The inputs that the key `inputs` of a model file names. Throws as
/// ConfigTable for none, for a name that is not an input and for one that is
/// there twice.
std::vector<Input> read_inputs(const ConfigTable& root);

/// Throws as ConfigTable for inputs that the rule forbids; `method` is its name
/// in the message.
void check_inputs(const ConfigTable& root, const std::vector<Input>& inputs,
                  InputRule rule, const std::string& method);

}  // namespace beamgyro::internal
