// SPDX-License-Identifier: MIT
#include "include/beamgyro/campaign.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "include/beamgyro/set.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::campaign_api_test {
namespace {

namespace fs = std::filesystem;

const fs::path kScenarios = BEAMGYRO_SCENARIOS;

beamgyro::Campaign six() {
  return beamgyro::Campaign::read(kScenarios / "campaigns/small.toml", 6);
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(PublicCampaign, TextsInMemoryDrawTheSameDevices) {
  const auto read = six();
  const auto parsed = beamgyro::Campaign::parse(read.files(), 6);
  EXPECT_EQ(parsed.devices(), 6U);
  EXPECT_EQ(parsed.runs(), read.runs());
  EXPECT_FALSE(read.device_overrides(3).empty());
  EXPECT_EQ(parsed.device_overrides(3), read.device_overrides(3));
  EXPECT_NE(read.device_overrides(3), read.device_overrides(4));
  EXPECT_EQ(read.device(3).overrides(), read.device_overrides(3));
}

TEST(PublicCampaign, HasNoDeviceBeyondItsNumber) {
  EXPECT_THROW(six().device(6), std::invalid_argument);
  EXPECT_THROW(six().device_overrides(99), std::invalid_argument);
}

TEST(PublicSet, ACancelledGenerationGoesOnToTheSameBytes) {
  const TestDirectory folder;
  const auto campaign = six();
  EXPECT_THROW(generate(campaign, folder.directory,
                        {.jobs = 1,
                         .progress = [](double share) { return share < 0.9; }}),
               Cancelled);
  EXPECT_THROW(beamgyro::Set::open(folder.directory), std::invalid_argument);
  const GenerationOutcome outcome =
      generate(campaign, folder.directory, {.jobs = 2, .resume = true});
  EXPECT_EQ(outcome.files, outcome.planned_files);
  EXPECT_LT(outcome.files_made, outcome.files);  // one was there
  const std::string manifest = bytes_of(folder.directory / "manifest.jsonl");
  fs::remove_all(folder.directory);
  generate(campaign, folder.directory);
  EXPECT_EQ(bytes_of(folder.directory / "manifest.jsonl"), manifest);
}

TEST(PublicSet, GivesRecordingsPartsAndDrawnNumbers) {
  const TestDirectory folder;
  const auto campaign = six();
  generate(campaign, folder.directory);
  const auto set = beamgyro::Set::open(folder.directory);
  EXPECT_EQ(set.devices(), 6U);
  EXPECT_EQ(set.runs(), campaign.runs());
  std::size_t together = 0;
  for (const auto part :
       {beamgyro::SetPart::kTrain, beamgyro::SetPart::kValidation,
        beamgyro::SetPart::kTest})
    together += set.devices_of(part).size();
  EXPECT_EQ(together, 6U);
  const Recording run = set.recording("warm_up", 5);
  EXPECT_EQ(column_values(run, "rate").size(), run.time.size());
  EXPECT_NE(column_values(run, "rate"),
            column_values(set.recording("warm_up", 4), "rate"));
  EXPECT_FALSE(set.slow_recording("warm_up", 5).columns.empty());
  EXPECT_FALSE(set.drawn_parameters("warm_up", 5).empty());
  EXPECT_TRUE(set.verify().empty());
  EXPECT_THROW(set.recording("warm_up", 6), std::invalid_argument);
  EXPECT_THROW(set.recording("cool_down", 0), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::campaign_api_test
