// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard_builder.h"
#include "sim/campaign/campaign.h"
#include "sim/campaign/shard_plan.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"

namespace beamgyro::internal {

/// Counts of the work that is done so far. Other threads may read them.
struct GenerationCounts {
  std::atomic<std::uint64_t> device_runs{0}, failures{0};
  // Called after each, by many threads; what it throws ends the work.
  std::function<void()> on_device_run = {};
};

struct MadeShard {
  std::unique_ptr<ShardBuilder> file;  // finished
  std::span<const std::byte> bytes;    // of the file
  std::vector<DeviceFailure> failures;
  CautionCounts cautions;
};

/// Makes shard files one after the other. The bytes of a file depend on the
/// campaign alone, not on what the maker made before. Use one object per
/// thread: each integrator in it has its own SUNDIALS context.
class ShardMaker {
 public:
  explicit ShardMaker(const ShardPlan& plan) : plan_(plan) {}

  /// Makes one file. A device that cannot be built or simulated becomes a row
  /// of fill values and is listed as a failure with its reason. Only these
  /// exceptions count as that:
  /// - std::invalid_argument and SimulationFailure from drawing and simulating
  ///   it;
  /// - UnstorableSamples.
  /// Any other exception goes to the caller.
  MadeShard make(std::uint32_t file, GenerationCounts& counts);

 private:
  struct PreparedDevice {
    VirtualDevice drawn;
    std::optional<TrimmedGyro> gyro;
    DeviceRow row;  // its failure, if there is no gyro
  };
  void prepare(std::uint32_t range);
  EncodedDevice encoded(const ShardBuilder& file, std::uint32_t position,
                        const PreparedDevice& device, const VirtualRun& run,
                        const RunKey& key, DeviceRow& row,
                        CautionCounts& cautions) const;
  Recording recorded(const PreparedDevice& device, const VirtualRun& run,
                     const RunKey& key, const ShardHead& head,
                     DeviceRow& row) const;

  const ShardPlan& plan_;
  std::optional<std::uint32_t> range_;
  std::vector<PreparedDevice> prepared_;  // devices of the range made last
};

/// Receives a finished shard file. It is called from several threads at once.
using ShardSink =
    std::function<void(std::uint32_t file, const MadeShard& shard)>;

/// Makes the shard files `files` of `plan` on `jobs` threads; 0 means one per
/// core. The bytes of a file do not depend on `jobs`. Rethrows exceptions, also
/// those of `publish`, as for_each_task().
void generate_shards(const ShardPlan& plan,
                     const std::vector<std::uint32_t>& files, unsigned jobs,
                     GenerationCounts& counts, const ShardSink& publish);

}  // namespace beamgyro::internal
