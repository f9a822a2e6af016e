// SPDX-License-Identifier: MIT
#pragma once

#include <cfloat>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// The C functions that exported code calls, compiled with this program. Built
/// with contraction of multiplications and additions off, exported code gives
/// the same bits.
namespace runtime {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "compensation/firmware/runtime.c99"
#pragma GCC diagnostic pop
}  // namespace runtime

/// Their sections, in the order of the source text.
const std::vector<std::string_view>& runtime_sections();

/// Source text (C99) of a section. Throws std::logic_error for a name that is
/// not one of runtime_sections().
std::string runtime_text(std::string_view section);

}  // namespace beamgyro::internal
