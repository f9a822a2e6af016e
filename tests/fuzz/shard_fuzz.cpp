// SPDX-License-Identifier: MIT
// A file of a set, with all its devices.
#include "dataset/set/shard/shard_builder.h"
#include "dataset/set/shard/shard_reader.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/hdf5_seeds.h"

namespace {

using namespace beamgyro::internal;

std::string shard_of(const ShardHead& head) {
  ShardBuilder builder(head);
  for (std::uint32_t device = 0; device < head.devices; ++device) {
    const beamgyro::Recording recording = sample_recording_of(head, device);
    builder.add(sample_row(head, device), &recording);
  }
  const std::span<const std::byte> bytes = builder.finish();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Files in chunks with slow variables, and contiguous ones.
std::vector<std::string> shards() {
  return {shard_of(sample_head(2, 40, 4)),
          shard_of(sample_head(2, 20, 1, false))};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  static const Hdf5Seeds seeds(shards);
  const std::filesystem::path file =
      scratch_file("shard.h5", seeds.file_of(text_of(data, size)));
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
