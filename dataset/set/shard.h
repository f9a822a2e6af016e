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

/// Storage type of the values in a file.
enum class Storage { kFloat64, kFloat32, kInt16, kInt32 };

/// A variable over (device, time), or over (device, truth_time) when slow.
struct SetVariable {
  std::string name, units, long_name;
  Role role = Role::kMeasured;
  Storage storage = Storage::kFloat32;
  /// For integers: value = count * scale_factor + add_offset. The lowest count
  /// of the type is NaN.
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

/// Thrown for samples of a recording that a set cannot hold: not finite, or
/// beyond their storage type.
class UnstorableSamples : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One device in the form in which it will stand in the file.
struct EncodedDevice {
  DeviceRow row;
  /// Chunks of status, then of every variable.
  std::vector<std::vector<PackedChunk>> variables;
};

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

  /// Encodes the device at this position of the file, the expensive part of
  /// adding it. May be called from many threads at once and in any order.
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

/// Returns truth_time: every slow_step-th time.
std::vector<double> slow_times(const ShardHead& head);
std::size_t slow_length(const ShardHead& head);

/// Returns the length of the chunks of a row of `values` values: rows are
/// divided into equal parts of up to 128 Ki values.
std::size_t chunk_length(std::size_t values);

}  // namespace beamgyro
