// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/set_check.h"
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

/// Returns the bytes that write_view() writes. Throws std::runtime_error when
/// HDF5 fails.
std::vector<std::byte> view_bytes(const ShardHead& head,
                                  std::span<const ManifestEntry> entries);

/// Publishes directory/NAME.nc, where NAME is the run of `head`: all devices of
/// the run as one dataset with the same variables, which HDF5 reads from the
/// files that `entries` name. `head` is that of any file of the run; `entries`
/// are those of this run, by device. The values of a missing or damaged file
/// read as NaN or the fill value, as unpowered, and as 255 in part and
/// device_status. HDF5 reports no error then; the manifest tells. Throws
/// std::runtime_error when HDF5 fails, and as publish_file().
ManifestView write_view(const std::filesystem::path& directory,
                        const ShardHead& head,
                        std::span<const ManifestEntry> entries);

/// Returns the views that differ from what write_view() makes of their files,
/// in the manifest or on the disk. It reads the first file of each run, so a
/// run with one of the `known` defects is left out. Throws as ShardFile.
std::vector<FileDefect> check_views(const std::filesystem::path& directory,
                                    const Manifest& manifest,
                                    std::span<const FileDefect> known);

}  // namespace beamgyro::internal
