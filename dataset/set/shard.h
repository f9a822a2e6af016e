// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "dataset/recording.h"
#include "dataset/set/chunk_filters.h"

namespace beamgyro {

inline constexpr const char* kSetFiletype = "beamgyro-set";
inline constexpr int kSetFormatVersion = 2;

/// How values stand in a file.
enum class Storage { kFloat64, kFloat32, kInt16, kInt32 };

/// A variable over (device, time), or over (device, truth_time) when slow.
struct SetVariable {
  std::string name, units, long_name;
  Role role = Role::kMeasured;
  Storage storage = Storage::kFloat32;
  /// Integers: value = count * scale_factor + add_offset; the lowest count of
  /// the type is NaN.
  double scale_factor = 1, add_offset = 0;
  bool slow = false;
};

/// A variable over (device), one number for each.
struct DeviceVariable {
  std::string name, units, long_name;
};

/// What all devices of one file share.
struct ShardHead {
  std::uint32_t first_device = 0, devices = 0;
  std::vector<double> time;   // [s], strictly increasing
  std::size_t slow_step = 1;  // truth_time is every slow_step-th time; with 1
                              // there is none, and nothing is slow
  std::vector<SetVariable> variables;
  std::vector<DeviceVariable> parameters;
  bool compress = true;
  std::string run, fidelity, program_version, git_revision;
  std::uint64_t seed = 0;
  std::string campaign_text, scenario_text, device_text, overrides_text;
};

enum DeviceStatus : std::uint8_t {
  kDeviceOk,
  kInvalidParameters,
  kNoConvergence,
  kNotFinite,
};

struct DeviceRow {
  std::vector<double> parameters;  // one per ShardHead::parameters
  std::uint8_t part = 0;           // 0 train, 1 validation, 2 test
  std::string failure;             // why there are no values; empty: there are
  std::uint8_t device_status = 0;  // DeviceStatus
};

/// Samples of a recording that a set cannot hold: not finite, or beyond their
/// storage.
class UnstorableSamples : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One device as it will stand in the file.
struct EncodedDevice {
  DeviceRow row;
  /// Chunks of status, then of every variable.
  std::vector<std::vector<PackedChunk>> variables;
};

/// A file of a set made in memory: an HDF5 image without any file behind it, so
/// that nothing HDF5 does can meet a full disk. The bytes depend on the input
/// alone. All calls throw std::runtime_error when HDF5 fails.
class ShardBuilder {
 public:
  /// Throws std::runtime_error for a head with a defect.
  explicit ShardBuilder(ShardHead head);
  ~ShardBuilder();
  ShardBuilder(const ShardBuilder&) = delete;
  ShardBuilder& operator=(const ShardBuilder&) = delete;

  const ShardHead& head() const { return head_; }

  /// The expensive part of adding the device of this position in the file; may
  /// be called from many threads at once and in any order. `recording` holds
  /// every variable (columns by name, one value per time of the head) and is
  /// not used of a failed device: all its values are fill values, its status is
  /// unpowered. Of 16-bit counts the lowest becomes the one above it, since it
  /// means NaN. Throws, naming device, variable and sample:
  ///  - UnstorableSamples for samples with a defect (samples_defect()), and for
  ///    values that their storage cannot hold: no whole number of counts (to
  ///    1e-6), or beyond its range;
  ///  - std::runtime_error for a recording that is not one of this file: other
  ///    times, a variable of the head missing.
  EncodedDevice encode(std::uint32_t position, const DeviceRow& row,
                       const Recording* recording) const;

  /// The next device.
  void add(const EncodedDevice& device);
  void add(const DeviceRow& row, const Recording* recording);

  /// The bytes of the file once every device is added; they live as long as the
  /// builder.
  std::span<const std::byte> finish();

 private:
  class Image;

  ShardHead head_;
  std::vector<DeviceRow> rows_;
  std::unique_ptr<Image> image_;
};

/// truth_time: every slow_step-th time.
std::vector<double> slow_times(const ShardHead& head);
std::size_t slow_length(const ShardHead& head);

/// Of a chunk of a row of `values` values: rows are cut into equal parts of up
/// to 128 Ki values.
std::size_t chunk_length(std::size_t values);

}  // namespace beamgyro
