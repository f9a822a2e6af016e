// SPDX-License-Identifier: MIT
#include "validation/qualification/seed_draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "sim/scenario/scenario_file.h"
#include "validation/qualification/qualification_file.h"

namespace beamgyro::internal::seed_draw_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

const Qualification& shipped() {
  static const Qualification qualification =
      read_qualification(kScenarios / "qualification.toml");
  return qualification;
}

std::vector<std::string> names_of(const Qualification& qualification) {
  std::vector<std::string> names;
  for (const QualificationRun& run : qualification.runs)
    names.push_back(run.name);
  return names;
}

std::map<std::string, QualificationRun> runs_of(
    const Qualification& qualification) {
  std::map<std::string, QualificationRun> runs;
  for (const auto* all : {&qualification.runs, &qualification.training,
                          &qualification.held_out, &qualification.turning})
    for (const QualificationRun& run : *all) runs.emplace(run.name, run);
  return runs;
}

double start_of(const QualificationRun& run) {
  return run.scenario.ambient.value(0.0) - 273.15;  // [degC]
}

TEST(SeedDraw, TheSameSeedGivesTheSameRunsInTheSameOrder) {
  const Qualification one = drawn_qualification(shipped(), 5);
  const Qualification other = drawn_qualification(shipped(), 5);
  EXPECT_EQ(names_of(one), names_of(other));
  for (std::size_t k = 0; k < one.runs.size(); ++k)
    EXPECT_EQ(one.runs[k].overrides_text, other.runs[k].overrides_text);
}

TEST(SeedDraw, AnotherSeedGivesOtherNoiseOrderTemperaturesAndLengths) {
  const Qualification first = drawn_qualification(shipped(), 5);
  const Qualification second = drawn_qualification(shipped(), 6);
  EXPECT_NE(names_of(first), names_of(second));
  EXPECT_NE(names_of(first), names_of(shipped()));
  const auto stated = runs_of(shipped()), one = runs_of(first),
             other = runs_of(second);
  ASSERT_EQ(one.size(), stated.size());
  std::set<std::uint64_t> seeds;
  for (const auto& [name, run] : one) {
    EXPECT_LT(run.scenario.seed, std::uint64_t{1} << 53) << name;
    EXPECT_TRUE(seeds.insert(run.scenario.seed).second) << name;
    EXPECT_TRUE(seeds.insert(other.at(name).scenario.seed).second) << name;
  }
  for (const QualificationRun& run : first.runs) {
    const QualificationRun& again = other.at(run.name);
    EXPECT_NE(start_of(run), start_of(again)) << run.name;
    EXPECT_NE(start_of(run), start_of(stated.at(run.name))) << run.name;
    EXPECT_NE(run.scenario.duration, again.scenario.duration) << run.name;
    EXPECT_EQ(run.purpose, stated.at(run.name).purpose) << run.name;
    EXPECT_EQ(run.from, stated.at(run.name).from) << run.name;
  }
}

TEST(SeedDraw, ARunIsThatOfItsScenarioWithItsOverrides) {
  for (const QualificationRun& run : drawn_qualification(shipped(), 7).runs) {
    std::vector<std::string> lines;
    std::istringstream text(run.overrides_text);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    const Overrides overrides(lines);  // refuses a key that is there twice
    const ScenarioPlan again = read_scenario(ConfigDocument::parse(
        run.scenario_text, run.document->path().string(), overrides));
    EXPECT_TRUE(overrides.all_used()) << run.name;
    EXPECT_EQ(again.seed, run.scenario.seed) << run.name;
    EXPECT_EQ(again.duration, run.scenario.duration) << run.name;
    for (const double t : {0.0, 4000.0, 30000.0})
      EXPECT_EQ(again.ambient.value(t), run.scenario.ambient.value(t))
          << run.name;
  }
}

// What the shipped file says of its spans, over many seeds.
TEST(SeedDraw, TheShippedSpansKeepWhatChecksAndModelsNeed) {
  constexpr double kReach = 21.0;  // [K], twice that of a table
  constexpr double kLowest = -41, kHighest = 51.5;  // [degC]
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::vector<double> tables;  // [degC]
    for (const QualificationRun& run :
         drawn_qualification(shipped(), seed).runs) {
      if (run.purpose == RunPurpose::kRateTable)
        tables.push_back(start_of(run));
      for (double t = 0; t < run.scenario.duration; t += 600) {
        EXPECT_GT(run.scenario.ambient.value(t) - 273.15, kLowest) << run.name;
        EXPECT_LT(run.scenario.ambient.value(t) - 273.15, kHighest) << run.name;
      }
    }
    std::ranges::sort(tables);
    ASSERT_EQ(tables.size(), 5);
    for (std::size_t k = 1; k < tables.size(); ++k)
      EXPECT_LT(tables[k] - tables[k - 1], kReach) << seed;
  }
}

TEST(SeedDraw, DrawsDependOnNamesAlone) {
  Qualification shorter = shipped();
  shorter.runs.erase(shorter.runs.begin());
  const auto whole = runs_of(drawn_qualification(shipped(), 9));
  for (const QualificationRun& run : drawn_qualification(shorter, 9).runs)
    EXPECT_EQ(run.overrides_text, whole.at(run.name).overrides_text);
  EXPECT_NE(drawn_campaign_seed(1), drawn_campaign_seed(2));
}

}  // namespace
}  // namespace beamgyro::internal::seed_draw_test
