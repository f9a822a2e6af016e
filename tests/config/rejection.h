// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace beamgyro::internal {

/// The message with which `work` rejects its input.
template <class Work>
std::string rejection(const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was rejected";
  return {};
}

}  // namespace beamgyro::internal
