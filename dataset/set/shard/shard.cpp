// SPDX-License-Identifier: MIT
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

std::vector<double> slow_times(const ShardHead& head) {
  std::vector<double> times;
  for (std::size_t k = 0; k < head.time.size(); k += head.slow_step)
    times.push_back(head.time[k]);
  return times;
}

std::size_t slow_length(const ShardHead& head) {
  return (head.time.size() + head.slow_step - 1) / head.slow_step;
}

std::size_t chunk_length(std::size_t values) {
  constexpr std::size_t kLongest = std::size_t{128} << 10;
  const std::size_t chunks = (values + kLongest - 1) / kLongest;
  return (values + chunks - 1) / chunks;
}

}  // namespace beamgyro::internal
