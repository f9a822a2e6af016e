// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Returns the text of a compensator file: JSON with `filetype`
/// "beamgyro-compensator" (docs/reference/compensator_file.md). Every number is
/// written so that reading it returns the same bits. Throws std::runtime_error
/// for a parameter that is not finite.
std::string compensator_text(const FittedCompensator& compensator);

/// Reads the text that compensator_text() made; `name` is the name of the file
/// in messages. Throws std::invalid_argument with the name and
/// - line and column, for a text that is not JSON;
/// - the key, for a value that is missing, of the wrong type or size, or not
///   finite;
/// - the version, for a newer format.
FittedCompensator parse_compensator(const std::string& text,
                                    const std::string& name);

/// Returns the text of a compensator file. Throws as read_json_text().
std::string read_compensator_text(const std::filesystem::path& file);

/// Reads a compensator file. Throws as read_compensator_text() and
/// parse_compensator().
FittedCompensator read_compensator(const std::filesystem::path& file);

}  // namespace beamgyro::internal
