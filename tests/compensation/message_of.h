// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace beamgyro::internal {

/// Text of the std::invalid_argument that `call` throws; "no error" when it
/// does not throw.
template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace beamgyro::internal
