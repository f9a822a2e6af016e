// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "dataset/recording/recording.h"
#include "dataset/set/shard/chunk_filters.h"
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

/// Thrown for samples of a recording that a set cannot hold: not finite, or
/// beyond their storage type.
class UnstorableSamples : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One device in the form in which it will stand in the file.
struct EncodedDevice {
  DeviceRow row;
  /// Chunks of status, then of every variable.
  std::vector<std::vector<PackedChunk>> variables;
};

/// Encodes the device at this position of the file, the expensive part of
/// adding it; calls share nothing.
/// `recording` has every variable (columns by name, one value for each time
/// of the head). For a failed device it is not used: all values are fill
/// values and the status is unpowered. The lowest 16-bit count becomes the
/// one above it, because it means NaN. Throws, naming device, variable and
/// sample:
/// - UnstorableSamples for samples with a defect (samples_defect()), and for
///   values that their storage cannot hold: no whole number of counts (to
///   1e-6), or beyond its range;
/// - std::runtime_error for a recording that is not one of this file: other
///   times, a variable of the head missing.
EncodedDevice encode_device(const ShardHead& head, std::uint32_t position,
                            const DeviceRow& row, const Recording* recording);

}  // namespace beamgyro::internal
