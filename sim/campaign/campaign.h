// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/set/source_copies.h"
#include "sim/campaign/draw_plan.h"
#include "sim/campaign/drawn_keys.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"

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

/// One scenario that every device goes through.
struct CampaignRun {
  std::string name;  // [a-z][a-z0-9_]*
  std::filesystem::path scenario_file;
  std::string scenario_text;  // byte for byte
};

struct VirtualDevice {
  std::vector<double> parameters;          // one per CampaignPlan::parameters()
  std::optional<DeviceParameters> device;  // none when it cannot be built
  std::string overrides;  // KEY=VALUE lines that make it of the base
  std::string failure;    // why not, one line
};

/// One run of one device.
struct VirtualRun {
  std::vector<double> parameters;  // one per CampaignPlan::run_parameters()
  std::optional<ScenarioPlan> scenario;
  std::string overrides;  // KEY=VALUE lines that make it of the scenario file
  std::string failure;
};

struct CampaignState;

/// A population of devices and the runs of each of them, read from a campaign
/// file (docs/reference/campaign_file.md). Immutable; its const members may be
/// called by many threads at once, and what they return depends on the
/// campaign's files and their arguments alone.
class CampaignPlan {
 public:
  /// Reads a campaign. `devices` replaces the number of devices in the file.
  /// Checks the base device, every scenario, every choice and the median of
  /// every distribution. Throws std::invalid_argument "file:line:column: key:
  /// ...".
  static CampaignPlan read(const std::filesystem::path& file,
                           std::optional<long> devices = {});

  /// The same from the copies that a set keeps, the campaign first. It reads no
  /// other file, because the maker of the set may have named any file. Also
  /// throws std::invalid_argument for a file that has no copy.
  static CampaignPlan of_copies(std::span<const SourceText> copies,
                                std::optional<long> devices = {});

  const std::string& name() const;
  const std::string& text() const;  // byte for byte
  std::uint32_t devices() const;
  std::uint32_t devices_per_file() const;
  std::uint64_t seed() const;
  const CampaignOutput& output() const;
  const std::vector<CampaignRun>& runs() const;
  const DeviceParameters& base_device() const;
  const std::string& device_text() const;
  /// Returns the scenario of a run as its file says, with the seed of the
  /// campaign.
  const ScenarioPlan& base_scenario(std::size_t run) const;
  /// Returns campaign, device, scenarios and their profiles in the order of
  /// reading.
  const std::vector<SourceText>& sources() const;

  const std::vector<DeviceVariable>& parameters() const;
  const std::vector<DeviceVariable>& run_parameters(std::size_t run) const;

  /// Returns whether devices may differ in this dotted key of the device file.
  bool is_drawn(std::string_view device_key) const;
  /// Returns the axes that some device moves in a run.
  const MovedAxes& moved_axes(std::size_t run) const;

  /// Draws device number `index`, which may be larger than devices().
  VirtualDevice device(std::uint32_t index) const;
  /// Returns what is drawn for a device: keys, distributions, groups.
  const DrawPlan& device_plan() const;
  /// Builds the device at independent uniform numbers in (0, 1), one per
  /// parameters(), by a plan that is device_plan() but for its distributions.
  VirtualDevice device_at(const DrawPlan& plan,
                          std::vector<double> uniform) const;

  /// Draws the scenario of a device in a run, with the seed of the campaign.
  VirtualRun run(std::size_t run, std::uint32_t device) const;
  /// Returns the part of a device. It depends on a random number of the device
  /// and not on the number of devices.
  Part part(std::uint32_t device) const;

 private:
  explicit CampaignPlan(std::shared_ptr<const CampaignState> state);

  std::shared_ptr<const CampaignState> state_;
};

}  // namespace beamgyro::internal
