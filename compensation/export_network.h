// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace beamgyro {

/// C99 statements that return the answer of a network of these layer sizes to
/// its scaled inputs x, from the arrays weights_1, biases_1, ... of
/// FirmwareModel.
std::string network_lines(const std::vector<int>& sizes);

}  // namespace beamgyro
