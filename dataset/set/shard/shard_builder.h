// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dataset/set/shard/shard_encoding.h"

namespace beamgyro::internal {

/// Makes a file of a set in memory, as an HDF5 image without a file behind it,
/// so that HDF5 never meets a full disk. The bytes depend on the input alone.
/// All calls throw std::runtime_error when HDF5 fails.
class ShardBuilder {
 public:
  /// Throws std::runtime_error for a head with a defect.
  explicit ShardBuilder(ShardHead head);
  ~ShardBuilder();
  ShardBuilder(const ShardBuilder&) = delete;
  ShardBuilder& operator=(const ShardBuilder&) = delete;

  const ShardHead& head() const { return head_; }

  /// encode_device() for this file. May be called from many threads at once and
  /// in any order.
  EncodedDevice encode(std::uint32_t position, const DeviceRow& row,
                       const Recording* recording) const;

  /// Adds the next device.
  void add(const EncodedDevice& device);
  void add(const DeviceRow& row, const Recording* recording);

  /// Returns the bytes of the file after every device has been added. They are
  /// valid as long as the builder lives.
  std::span<const std::byte> finish();

 private:
  class Image;

  ShardHead head_;
  std::vector<DeviceRow> rows_;
  std::unique_ptr<Image> image_;
};

}  // namespace beamgyro::internal
