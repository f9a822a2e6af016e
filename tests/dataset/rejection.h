// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace beamgyro::internal {

/// The message of the `Error` that `work` throws.
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
