// SPDX-License-Identifier: MIT
#include "tests/sim/campaign/campaign_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

namespace beamgyro::internal {

CampaignFolder::CampaignFolder() {
  static std::atomic<int> count = 0;
  path_ =
      std::filesystem::path(testing::TempDir()) /
      ("campaign_" + std::to_string(getpid()) + "_" + std::to_string(count++));
  std::filesystem::create_directories(path_);
  std::filesystem::copy_file(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml",
      path_ / "nominal.toml");
  write("rest.toml",
        "name = \"rest\"\ndevice = \"nominal.toml\"\n"
        "fidelity = \"quasistatic\"\nduration_s = 10\noutput_rate_Hz = 10\n"
        "seed = 7\n[ambient]\nconstant_degC = 25\n");
}

CampaignFolder::~CampaignFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void CampaignFolder::write(const std::string& file,
                           const std::string& text) const {
  std::ofstream stream(path_ / file, std::ios::binary);
  stream << text;
  ASSERT_TRUE(stream.flush()) << file;
}

CampaignPlan CampaignFolder::campaign(const std::string& text) const {
  write("c.toml", text);
  return CampaignPlan::read(path_ / "c.toml");
}

std::string campaign_text(const std::string& tables, const std::string& keys,
                          const std::string& run) {
  return "name = \"test\"\ndevice = \"nominal.toml\"\ndevices = 100\n"
         "seed = 3\n" +
         keys + "\n" + tables +
         "\n[[run]]\nname = \"rest\"\nscenario = \"rest.toml\"\n" + run + "\n";
}

std::string with_tolerances(const std::string& tolerances,
                            const std::string& keys) {
  return campaign_text("[tolerances]\n" + tolerances, keys);
}

}  // namespace beamgyro::internal
