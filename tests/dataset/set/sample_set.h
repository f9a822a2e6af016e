// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

/// Variables of every storage and role, slow ones too if `slow_step` is not 1.
ShardHead sample_head(std::uint32_t devices, std::size_t samples,
                      std::size_t slow_step = 1, bool compress = true);

/// What `device` measured: unpowered for its first fifth; integers are exact
/// multiples of what they are stored in, and noise to any compressor in
/// `output`. The larger `device`, the larger every value.
Recording sample_recording_of(const ShardHead& head, std::uint32_t device);

DeviceRow sample_row(const ShardHead& head, std::uint32_t device);

/// A finished set of two runs of 5 devices in files of 2, device 3 failed, with
/// views and one source. Returns its manifest as written.
Manifest write_sample_set(const std::filesystem::path& directory);

}  // namespace beamgyro::internal
