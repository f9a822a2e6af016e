// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "compensation/compensator.h"

namespace beamgyro {

/// A compensator file: JSON with `filetype` "beamgyro-compensator"
/// (docs/reference/compensator_file.md). Every number is written so that
/// reading it returns the same bits. Throws std::runtime_error for a parameter
/// that is not finite.
std::string compensator_text(const Compensator& compensator);

/// Reads what compensator_text() wrote; `name` is the file's in messages.
/// Throws std::invalid_argument with the name and the line and column of what
/// is not JSON, or the key that is missing, of the wrong type or size, not
/// finite, or of a newer format version.
Compensator parse_compensator(const std::string& text, const std::string& name);

/// Throws as compensator_text() and write_text_file().
void write_compensator(const Compensator& compensator,
                       const std::filesystem::path& file);

/// Throws as read_text_file() and parse_compensator().
Compensator read_compensator(const std::filesystem::path& file);

}  // namespace beamgyro
