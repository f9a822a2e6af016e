// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "sim/campaign/campaign.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal {

/// A folder of its own with the nominal device, a short scenario at 25 degC
/// and what a test writes into it; deleted at the end.
class CampaignFolder {
 public:
  CampaignFolder();

  const std::filesystem::path& path() const { return folder_.directory; }
  void write(const std::string& file, const std::string& text) const;
  /// Writes rest.toml: ten seconds, with `more` behind the other keys.
  void write_rest(const std::string& more) const;
  /// Writes c.toml and reads it.
  CampaignPlan campaign(const std::string& text) const;

 private:
  TestDirectory folder_;
};

/// A campaign of 100 devices and one run "rest" of that scenario. `keys` are
/// top-level keys, `tables` what follows; the run's own keys come last.
std::string campaign_text(const std::string& tables,
                          const std::string& keys = "",
                          const std::string& run = "");

/// campaign_text with [tolerances].
std::string with_tolerances(const std::string& tolerances,
                            const std::string& keys = "");

}  // namespace beamgyro::internal
