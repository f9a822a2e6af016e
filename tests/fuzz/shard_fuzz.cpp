// SPDX-License-Identifier: MIT
// A file of a set, with all its devices.
#include "dataset/set/shard/shard_reader.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beamgyro::internal;
  const std::filesystem::path file =
      scratch_file("shard.h5", text_of(data, size));
  accept_or_reject([&] {
    const ShardFile shard(file);
    for (std::uint32_t k = 0; k < shard.devices(); ++k) {
      if (!shard.row(k).failure.empty()) continue;
      static_cast<void>(shard.recording(k));
      static_cast<void>(shard.slow_recording(k));
    }
  });
  return 0;
}
