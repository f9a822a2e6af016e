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

/// Succeeds when `text` holds `part`; the failure prints the text.
inline testing::AssertionResult holds(const std::string& text,
                                      const std::string& part) {
  if (text.find(part) != text.npos)
    return testing::AssertionSuccess() << "holds \"" << part << "\": " << text;
  return testing::AssertionFailure() << "no \"" << part << "\" in: " << text;
}

}  // namespace beamgyro::internal
