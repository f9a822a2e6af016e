// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

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
  std::string comment = {};  // attribute; mostly empty
};

/// A variable over (device), one number for each. The name is an identifier
/// such as "patches_offset_m_0".
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

}  // namespace beamgyro::internal
