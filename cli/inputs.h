// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/source_copies.h"
#include "include/beamgyro/recording.h"

namespace beamgyro::internal {

/// Reads a recording, as CSV when the name ends in .csv. For an HDF5 file
/// without a checksum it keeps a warning, which is printed when the command
/// succeeds.
Recording load_recording(const std::filesystem::path& path);

/// Largest number of a device of a set.
constexpr long kLastDevice = 4294967295;

/// Throws std::invalid_argument unless `path`, the argument of -o, has one of
/// these endings, those of a recording, or none of a file.
void require_ending(const std::filesystem::path& path,
                    const std::vector<std::string>& endings);
void require_recording_name(const std::filesystem::path& path);
/// The same for the argument of `option`, the name of a directory.
void require_directory_name(const std::filesystem::path& path,
                            std::string_view option = "-o");

/// Prepares the note for an interruption. Throws what writing to `output` would
/// throw at its start. Throws
/// std::invalid_argument when `output` is one of the files that the command
/// reads, under whatever name. `inputs` has all files that the command reads,
/// also those that other inputs name; a directory stands for everything below
/// it.
void require_output(const std::filesystem::path& output,
                    const std::vector<std::filesystem::path>& inputs);

/// The same for the argument of `option`, which may be empty: a file of another
/// kind is not written over by mistake. Any other name passes.
void require_json_output(const std::string& name,
                         const std::vector<std::filesystem::path>& inputs,
                         std::string_view option = "--json");

/// The same for `file` in the directory `name`, the argument of `option`, which
/// may be empty. Leaves no directory that was not there.
void require_output_directory(const char* option, const std::string& name,
                              const char* file,
                              const std::vector<std::filesystem::path>& inputs);

/// The same for the files that `generate` makes in a directory.
void require_set_output(const std::filesystem::path& directory,
                        const ManifestHead& head,
                        const std::vector<SourceText>& inputs);

}  // namespace beamgyro::internal
