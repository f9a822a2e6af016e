// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/document.h"
#include "sim/campaign/campaign.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/profile_keys.h"

namespace beamgyro::internal {

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
void set_as_built(const Trims& trims, const Gyro& base,
                  DeviceParameters& device);

/// The contents of a campaign file, read and checked.
struct CampaignState {
  std::string name, text;
  std::uint32_t devices = 0, devices_per_file = 0;
  CampaignOutput output;
  Distribution split;  // of Part
  Trims trims;
  UniformSource source;
  std::vector<SourceText> sources;
  ProfileTables profiles;  // of the scenarios, as they were read

  std::optional<ConfigDocument> device_document;
  DeviceParameters device;
  std::optional<Gyro> base_gyro;  // where a trim is left out
  DrawPlan device_plan;

  // One entry of each for each run.
  std::vector<CampaignRun> runs;
  std::vector<ConfigDocument> scenario_documents;
  std::vector<ScenarioPlan> scenarios;
  std::vector<DrawPlan> run_plans;
  std::vector<MovedAxes> moved_axes;  // by some device
};

/// See CampaignPlan::read and CampaignPlan::of_copies.
CampaignState read_campaign(const std::filesystem::path& file,
                            std::optional<long> devices);
CampaignState read_campaign(std::span<const SourceText> copies,
                            std::optional<long> devices);

}  // namespace beamgyro::internal
