// SPDX-License-Identifier: MIT
#include "tests/sim/campaign/campaign_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace beamgyro::internal {

CampaignFolder::CampaignFolder() {
  std::filesystem::copy_file(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml",
      path() / "nominal.toml");
  write_rest("[ambient]\nconstant_degC = 25\n");
}

void CampaignFolder::write_rest(const std::string& more) const {
  write("rest.toml",
        "name = \"rest\"\ndevice = \"nominal.toml\"\n"
        "fidelity = \"quasistatic\"\nduration_s = 10\noutput_rate_Hz = 10\n"
        "seed = 7\n" +
            more);
}

void CampaignFolder::write(const std::string& file,
                           const std::string& text) const {
  std::ofstream stream(path() / file, std::ios::binary);
  stream << text;
  ASSERT_TRUE(stream.flush()) << file;
}

CampaignPlan CampaignFolder::campaign(const std::string& text) const {
  write("c.toml", text);
  return CampaignPlan::read(path() / "c.toml");
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
