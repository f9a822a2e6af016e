// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/document.h"
#include "dataset/set/source_copies.h"
#include "sim/campaign/draw_plan.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

/// What the data of a device are used for.
enum class Part : std::uint8_t { kTrain, kValidation, kTest };

/// Variables, precision and sample rate of the files of the set.
struct CampaignOutput {
  std::vector<std::string> variables;  // names to keep; empty: all
  std::string variables_place;         // file:line:column: key
  bool double_precision = false;       // truth as float64 in place of float32
  double truth_rate = 0;  // [Hz] of all truth but true_rate; 0: the output rate
  bool compress = true;
};

/// Which quantities the factory trims at 25 degC.
struct Trims {
  bool quadrature = true, offset = true, scale_factor = true;
};

/// Sets the keys of the quantities that were not trimmed. A unit without a trim
/// keeps the setting of the base unit (docs/model.md), so the keys become:
/// - its quadrature under the base unit's k_trim;
/// - its scale factor under the base unit's gain;
/// - its output at T_0 and rest under the base unit's offset.
/// Throws SimulationFailure when the drive loop does not lock.
void set_as_built(const Trims& trims, const TrimmedGyro& base,
                  DeviceParameters& device);

/// Returns the axes that some device may move: those of the scenario itself,
/// those of each choice of `plan` that can be drawn, and those with a number
/// from a continuous distribution. `profiles` are the files that they name.
PerAxis<bool> moved_axes(const ScenarioPlan& scenario,
                         const ConfigDocument& document, const DrawPlan& plan,
                         const ProfileTables& profiles);

/// One scenario that every device goes through.
struct CampaignRun {
  std::string name;          // [a-z][a-z0-9_]*
  ConfigDocument document;   // of the scenario
  ScenarioPlan scenario;     // as its file says, with the seed of the campaign
  DrawPlan plan;             // what differs between devices
  PerAxis<bool> moved_axes;  // by some device
};

struct VirtualDevice {
  std::vector<double> parameters;          // one per parameter of the plan
  std::optional<DeviceParameters> device;  // none when it cannot be built
  std::string overrides;  // KEY=VALUE lines that make it of the base
  std::string failure;    // why not, one line
};

/// One run of one device.
struct VirtualRun {
  std::vector<double> parameters;  // one per parameter of the plan of the run
  std::optional<ScenarioPlan> scenario;
  std::string overrides;  // KEY=VALUE lines that make it of the scenario file
  std::string failure;
};

/// A population of devices and the runs of each of them, read from a campaign
/// file (docs/reference/campaign_file.md) and checked. Its const members may be
/// called by many threads at once, and what they return depends on the
/// campaign's files and their arguments alone.
struct CampaignPlan {
  /// Reads a campaign. `devices` replaces the number of devices in the file,
  /// `seed` its seed.
  /// Checks the base device, every scenario, every choice and the median of
  /// every distribution. Throws std::invalid_argument "file:line:column: key:
  /// ...".
  static CampaignPlan read(const std::filesystem::path& file,
                           std::optional<long> devices = {},
                           std::optional<std::uint64_t> seed = {});

  /// The same from the copies that a set keeps, the campaign first. It reads no
  /// other file, because the maker of the set may have named any file. Also
  /// throws std::invalid_argument for a file that has no copy.
  static CampaignPlan of_copies(std::span<const SourceText> copies,
                                std::optional<long> devices = {});

  /// Returns whether devices may differ in this dotted key of the device file.
  /// In a drawn table they differ unless every choice has the value of the
  /// file.
  bool is_drawn(std::string_view device_key) const;

  /// Draws device number `index`, which may be larger than `devices`.
  VirtualDevice device(std::uint32_t index) const;
  /// Builds the device at independent uniform numbers in (0, 1), one per
  /// parameter, by a plan that is device_plan but for its distributions.
  VirtualDevice device_at(const DrawPlan& plan,
                          std::vector<double> uniform) const;

  /// Draws the scenario of a device in a run, with the seed of the campaign.
  VirtualRun run(std::size_t run, std::uint32_t device) const;
  /// Returns the part of a device. It depends on a random number of the device
  /// and not on the number of devices.
  Part part(std::uint32_t device) const;

  std::string name, text;  // the text byte for byte
  std::uint32_t devices = 0, devices_per_file = 0;
  CampaignOutput output;
  Distribution split;  // of Part
  Trims trims;
  UniformSource source;
  // Campaign, device, scenarios and their profiles in the order of reading.
  std::vector<SourceText> sources;
  ProfileTables profiles;  // of the scenarios, as they were read
  std::optional<ConfigDocument> device_document;
  DeviceParameters base_device;
  std::optional<TrimmedGyro> base_gyro;  // where a trim is left out
  DrawPlan device_plan;  // what is drawn: keys, distributions, groups
  std::vector<CampaignRun> runs;
};

}  // namespace beamgyro::internal
