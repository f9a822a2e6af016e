// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dataset/set/shard.h"

namespace beamgyro {

/// Of one value [byte].
std::size_t width_of(Storage storage);

/// What keeps the head from being one, as one line, or an empty text.
std::string shard_head_defect(const ShardHead& head);

/// Every `step`-th value as `variable` stores it, little-endian. Throws
/// UnstorableSamples "NAME: sample K is ...".
std::vector<std::byte> encoded_values(const SetVariable& variable,
                                      const std::vector<double>& values,
                                      std::size_t step);

/// `count` fill values.
std::vector<std::byte> fill_values(const SetVariable& variable,
                                   std::size_t count);

/// The values `bytes` stand for.
std::vector<double> decoded_values(const SetVariable& variable,
                                   const std::vector<std::byte>& bytes);

}  // namespace beamgyro
