// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

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

}  // namespace beamgyro::internal
