// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace beamgyro {

/// Returns the C99 statements that evaluate a network of these layer sizes at
/// its scaled inputs x, with the arrays weights_1, biases_1, ... of
/// FirmwareModel.
std::string network_lines(const std::vector<int>& sizes);

}  // namespace beamgyro
