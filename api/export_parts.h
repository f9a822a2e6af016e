// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/option_message.h"

namespace beamgyro::internal {

/// Runs `work` and puts the name of a file before an error.
template <class Work>
auto of_file(const std::string& file, Work work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw OptionError(file + ": ", error);
  }
}

/// Throws std::invalid_argument for an axis other than "x", "y" and "z".
void require_axes(const std::vector<std::string>& axes);

/// Returns one axis for each of `count` things called `what`: those that are
/// given, or without any z for one thing and x, y, z for three. Throws
/// OptionError for another number of axes or one that is given twice.
std::vector<char> axes_of(const std::vector<std::string>& given,
                          std::size_t count, const char* what);

}  // namespace beamgyro::internal
