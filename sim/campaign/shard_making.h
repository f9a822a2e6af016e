// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/shard.h"
#include "dataset/set/source_copies.h"
#include "sim/campaign/campaign.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"

namespace beamgyro {

/// Which program makes a set; part of its files.
struct ProgramRevision {
  std::string version, git_revision;
};

/// What the campaign was read from.
std::vector<SourceText> source_texts(const Campaign& campaign);

/// The files a campaign makes, in the order of the manifest: each holds the
/// devices of one range in one run (docs/formats.md).
class ShardPlan {
 public:
  /// Simulates two samples of every run with the base device to learn its
  /// variables. Throws std::invalid_argument for a variable that no run has and
  /// for a truth rate that is no part of an output rate.
  ShardPlan(const Campaign& campaign, const ProgramRevision& program);

  const ManifestHead& manifest_head() const { return manifest_head_; }

  std::uint32_t run_of(std::uint32_t file) const;
  std::uint32_t range_of(std::uint32_t file) const;
  ShardHead head_of(std::uint32_t file) const;

  /// Devices of `files` together.
  std::uint64_t device_runs(const std::vector<std::uint32_t>& files) const;
  /// Mean length of a run [s].
  double run_duration() const;

  /// Values of the largest file, before deflation [bytes].
  double largest_file() const;

  const Campaign& campaign() const { return *campaign_; }

 private:
  const Campaign* campaign_;
  ManifestHead manifest_head_;
  std::vector<ShardHead> heads_;  // one per run, for range 0
};

/// What is done so far, for whoever watches.
struct GenerationCounts {
  std::atomic<std::uint64_t> device_runs{0}, failures{0};
};

struct MadeShard {
  std::unique_ptr<ShardBuilder> file;  // finished
  std::span<const std::byte> bytes;    // of the file
  std::vector<DeviceFailure> failures;
};

/// Makes shard files one after the other. The bytes of a file depend on the
/// campaign alone, not on what the maker made before. One per thread: each
/// integrator in it has a SUNDIALS context of its own.
class ShardMaker {
 public:
  explicit ShardMaker(const ShardPlan& plan) : plan_(plan) {}

  /// A device that cannot be built or simulated is a row of fill values with
  /// its reason, and one of the failures. Throws what ShardBuilder throws.
  MadeShard make(std::uint32_t file, GenerationCounts& counts);

 private:
  struct PreparedDevice {
    VirtualDevice drawn;
    std::optional<Gyro> gyro;
    DeviceRow row;  // its failure, if there is no gyro
  };
  void prepare(std::uint32_t range);
  static Recording simulated(const PreparedDevice& device,
                             const VirtualRun& run, const RunKey& key,
                             const ShardHead& head, DeviceRow& row);

  const ShardPlan& plan_;
  std::optional<std::uint32_t> range_;
  std::vector<PreparedDevice> prepared_;  // devices of the range made last
};

}  // namespace beamgyro
