// SPDX-License-Identifier: MIT
#include "compensation/compensator/training_use.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::training_use_test {
namespace {

Recording some_run() {
  return RecordedRun{.bias = [](double t) { return std::sin(t); },
                     .powered = [](double t) { return t > 3.0; }}
      .recording();
}

TEST(TrainingUse, TellsARecordingByWhatWasMeasured) {
  const std::string hash = measured_sha256(some_run());
  Recording same = some_run();
  same.program_version = "another";
  same.seed = 17;
  same.scenario_text = "name = \"renamed\"";
  std::ranges::reverse(same.columns);
  for (Column& column : same.columns) {
    column.units = "?";
    if (column.role == Role::kTruth) column.values.assign(1200, 7.0);
  }
  same.columns.push_back({"compensated_rate", "degree/s", "",
                          Role::kCompensated,
                          std::vector<double>(same.time.size(), 1.0)});
  EXPECT_EQ(measured_sha256(same), hash);

  const auto changed = [&hash](const auto& change) {
    Recording other = some_run();
    change(other);
    return measured_sha256(other) != hash;
  };
  EXPECT_TRUE(changed([](Recording& r) { r.time.back() += 1e-9; }));
  EXPECT_TRUE(changed([](Recording& r) { r.status.back() = 2; }));
  EXPECT_TRUE(changed([](Recording& r) { r.columns[1].values[9] += 1e-9; }));
  EXPECT_TRUE(changed([](Recording& r) { r.columns[1].name = "rates"; }));
}

TEST(TrainingUse, KnowsFilesByEitherHash) {
  const Recording run = some_run();
  Provenance by_file;
  by_file.training = {{"a.h5", "abc"}};
  EXPECT_TRUE(was_used_in_training(by_file, "abc", run));
  EXPECT_FALSE(was_used_in_training(by_file, "", run));
  Provenance held_out;
  held_out.held_out = {{"b.h5", "def", measured_sha256(run)}};
  EXPECT_TRUE(was_used_in_training(held_out, "", run));
  EXPECT_FALSE(was_used_in_training(held_out, "",
                                    RecordedRun{.duration = 60.0}.recording()));
}

TEST(TrainingUse, KnowsDevicesOfASetByCampaignAndSeed) {
  const TrainingSet part{.name = "set",
                         .manifest_sha256 = "m",
                         .devices = 2,
                         .campaign_sha256 = "c",
                         .seed = 4,
                         .runs = {"sweep"},
                         .device_numbers = {3, 11}};
  const auto trained_on = [](const TrainingSet& set) {
    Provenance provenance;
    provenance.training_set = set;
    return provenance;
  };
  const auto used = [&](const TrainingSet& trained, const TrainingSet& set,
                        const char* device, const char* run) {
    TrainingRun of_set;
    of_set.device = device;
    of_set.run = run;
    return was_used_in_training(trained_on(trained), set, of_set);
  };
  EXPECT_TRUE(used(part, part, "11", "sweep"));
  EXPECT_TRUE(used(part, part, "3", "check"));
  EXPECT_FALSE(used(part, part, "1", "sweep"));
  TrainingSet longer = part;  // more devices of the same campaign
  longer.manifest_sha256 = "n";
  EXPECT_TRUE(used(part, longer, "11", "sweep"));
  longer.seed = 5;
  EXPECT_FALSE(used(part, longer, "11", "sweep"));
  TrainingSet one = part;
  one.devices = 1;
  one.device_numbers = {3};
  EXPECT_TRUE(used(one, part, "3", "sweep"));
  EXPECT_FALSE(used(one, part, "3", "check"));
  EXPECT_FALSE(may_have_used(trained_on(part), part));
  TrainingSet silent = part;
  silent.device_numbers.clear();
  EXPECT_TRUE(may_have_used(trained_on(silent), part));
}

}  // namespace
}  // namespace beamgyro::internal::training_use_test
