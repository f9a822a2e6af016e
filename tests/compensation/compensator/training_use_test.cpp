// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "compensation/compensator/run_comparison.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

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

Recording simulated_run(std::uint64_t seed, const std::string& scenario = "") {
  Recording run = some_run();
  run.fidelity = "quasistatic";
  run.title = "title: of a scenario";
  run.seed = seed;
  run.scenario_text = scenario;
  return run;
}

constexpr const char* kQuiet = "[noise]\nenabled = false\n";

TEST(NoiseSeed, IsThatOfASimulatedRunWithNoise) {
  EXPECT_EQ(noise_seed(simulated_run(7)), 7u);
  EXPECT_EQ(noise_seed(simulated_run(0, "[noise]\nenabled = true\n")), 0u);
  EXPECT_FALSE(noise_seed(simulated_run(7, kQuiet)));
  Recording run = simulated_run(7, "name = \"a\"\n");
  run.overrides_text = "noise.enabled=false\n";
  EXPECT_FALSE(noise_seed(run));
  for (const char* fidelity : {"imported", "csv"}) {
    run = simulated_run(7);
    run.fidelity = fidelity;
    EXPECT_FALSE(noise_seed(run)) << fidelity;
  }
  run = simulated_run(7);
  run.title.clear();  // as of a set
  EXPECT_FALSE(noise_seed(run));
}

TEST(NoiseSeed, OfTrainingIsToldOfOtherRuns) {
  Provenance provenance;
  provenance.training = {{"a.h5", "a", "", {}, 7}, {"old.h5", "b"}};
  provenance.held_out = {{"b.h5", "c", "", {}, 8}};
  EXPECT_EQ(shared_seed(provenance, "x.h5", simulated_run(7)),
            "x.h5 shares its seed of noise with the training run a.h5: turn-on "
            "offset and noise are the same");
  EXPECT_TRUE(holds(shared_seed(provenance, "x.h5", simulated_run(8)),
                    "held-out run b.h5"));
  EXPECT_EQ(shared_seed(provenance, "x.h5", simulated_run(9)), "");
  EXPECT_EQ(shared_seed(provenance, "x.h5", simulated_run(7, kQuiet)), "");
  EXPECT_EQ(shared_seed(provenance, "x.h5", some_run()), "");
}

TEST(NoiseSeed, InCommonIsWarnedOfWhereRunsAreScoredAsUnseen) {
  const SourceFile a{"a", "a", "", {}, 7}, b{"b", "b", "", {}, 7},
      c{"c", "c", "", {}, 8}, log{"log", "d"};
  EXPECT_EQ(warning_of_shared_seeds({a, b, log}, {c, log}, false), "");
  EXPECT_EQ(warning_of_shared_seeds({a, c, log}, {log}, true), "");
  EXPECT_EQ(
      warning_of_shared_seeds({a, c}, {b}, false),
      "a, b share the seed of noise 7: turn-on offset and noise are the same "
      "in them, so scores on unseen runs are too good; run all but one again "
      "with other seeds");
  EXPECT_EQ(warning_of_shared_seeds({a, b}, {c}, true).find("a, b share"), 0U);
  EXPECT_EQ(warning_of_shared_seeds({a, c}, {b, c}, false)
                .find("a, b share the seed of noise 7; c, c share"),
            0U);
}

std::string rejected(const std::vector<Recording>& training,
                     const std::vector<Recording>& held_out = {}) {
  const auto marks = [](const std::vector<Recording>& runs, char name) {
    std::vector<RunMark> result;
    for (const Recording& run : runs) {
      const std::string called(1, name++);
      result.push_back(mark_of({called, "sha of " + called, run}));
    }
    return result;
  };
  try {
    require_different_runs(marks(training, 'a'), marks(held_out, 'x'));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

Recording second_half(const Recording& run) {
  Recording half = run;
  const auto cut = [](auto& values) {
    values.erase(values.begin(),
                 values.begin() + static_cast<std::ptrdiff_t>(600));
  };
  cut(half.time);
  cut(half.status);
  for (Column& column : half.columns) cut(column.values);
  return half;
}

TEST(RunComparison, RefusesARunTwiceAndPartsOfOne) {
  const Recording run = some_run();
  Recording other =
      RecordedRun{.bias = [](double t) { return std::cos(t); }}.recording();
  EXPECT_EQ(rejected({run, other}), "");
  EXPECT_EQ(rejected({run}, {other}), "");
  EXPECT_EQ(rejected({run, other, run}),
            "c: is the same recording as a; expected each once: leave one of "
            "them out");
  EXPECT_EQ(rejected({second_half(run), run}),
            "a: half or more of its samples are those of b; expected each "
            "once: leave one of them out");
  EXPECT_TRUE(
      holds(rejected({other}, {run, run}), "y: is the same recording as x"));
  EXPECT_EQ(rejected({other, run}, {second_half(run)}),
            "x: half or more of its samples are those of b; a held-out "
            "recording must be another run than those that are trained on");
}

// Without noise every run of the same conditions has the same samples.
TEST(RunComparison, OfRunsWithoutNoiseTakesPartsOfOneScenarioOnly) {
  Recording run = some_run(), part = second_half(run);
  run.scenario_text = part.scenario_text = kQuiet;
  EXPECT_NE(rejected({run, part}), "");
  part.overrides_text = "duration_s=300\n";
  EXPECT_EQ(rejected({run, part}), "");
  EXPECT_NE(rejected({run, run}), "");
  part.scenario_text.clear();  // which may have noise
  EXPECT_NE(rejected({run, part}), "");
}

}  // namespace
}  // namespace beamgyro::internal::training_use_test
