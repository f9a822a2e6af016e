// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace beamgyro::internal {

std::string_view text_of(const std::uint8_t* data, std::size_t size);

/// What stands before and after the first line "=====". Without that line all
/// of it stands before.
std::pair<std::string_view, std::string_view> split(std::string_view text);

/// A directory of this process, in memory where the system has such a place. It
/// holds the shipped devices and scenarios, and is removed at the end.
const std::filesystem::path& scratch_folder();

/// A file in the scratch folder, with these bytes in place of any others.
std::filesystem::path scratch_file(std::string_view name,
                                   std::string_view bytes);

/// Calls `read`, which may refuse its input as the readers promise to: by
/// std::invalid_argument with a message. Any other exception ends the program.
template <class Read>
void accept_or_reject(Read&& read) {
  try {
    std::forward<Read>(read)();
  } catch (const std::invalid_argument& error) {
    if (*error.what() == '\0') throw std::logic_error("rejection without text");
  }
}

}  // namespace beamgyro::internal

/// One target; libFuzzer and the replay of the corpus call it. libFuzzer asks
/// for the name.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size);
