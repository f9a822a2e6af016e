// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace beamgyro::internal {

/// Returns the SHA-256 (FIPS 180-4) of `bytes` as 64 lower-case hexadecimal
/// digits, without a library that the binary of an FMU would need beside it.
std::string text_digest(std::string_view bytes);

}  // namespace beamgyro::internal
