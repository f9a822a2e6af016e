// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace beamgyro::internal {

/// Returns a document of nlohmann-json as the text of a file. Names of files
/// and of compensators need not be UTF-8: bytes that are not become U+FFFD.
template <class Json>
std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace beamgyro::internal
