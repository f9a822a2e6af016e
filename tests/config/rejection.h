// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace beamgyro::internal {

/// Returns the message of the `Error` that `work` throws. The test fails if
/// nothing is thrown.
template <class Error = std::invalid_argument, class Work>
std::string rejection(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was rejected";
  return {};
}

}  // namespace beamgyro::internal
