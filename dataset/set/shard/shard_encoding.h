// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
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

/// Returns truth_time: every slow_step-th time.
std::vector<double> slow_times(const ShardHead& head);
std::size_t slow_length(const ShardHead& head);

/// Returns the length of the chunks of a row of `values` values: rows are
/// divided into equal parts of up to 128 Ki values.
std::size_t chunk_length(std::size_t values);

/// Returns the size of one value [byte].
std::size_t width_of(Storage storage);

/// Returns the first defect of a head as one line, or an empty text.
std::string shard_head_defect(const ShardHead& head);

/// Returns every `step`-th value in the storage of `variable`, little-endian.
/// Throws UnstorableSamples "NAME: sample K is ...".
std::vector<std::byte> encoded_values(const SetVariable& variable,
                                      const std::vector<double>& values,
                                      std::size_t step);

/// Returns `count` fill values.
std::vector<std::byte> fill_values(const SetVariable& variable,
                                   std::size_t count);

/// Returns the values that `bytes` stand for.
std::vector<double> decoded_values(const SetVariable& variable,
                                   const std::vector<std::byte>& bytes);

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
