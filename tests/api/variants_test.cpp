// SPDX-License-Identifier: MIT
#include "include/beamgyro/variants.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "include/beamgyro/simulate.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::variants_test {
namespace {

const std::vector<std::string> kShort = {"duration_s=2", "noise.enabled=true"};

beamgyro::Scenario warm_up() {
  return beamgyro::Scenario::read(
      std::filesystem::path(BEAMGYRO_SCENARIOS) / "warm_up.toml", kShort);
}

// An axis of the scenario, one of the device and one of both.
std::vector<VariedValues> axes() {
  return {{{"seed=1"}, {"seed=2"}},
          {{"beam.length_m=0.0399"}, {"beam.length_m=0.0401"}},
          {{"fidelity=\"envelope\"", "noise.enabled=false"},
           {"beam.side_difference=0.001", "output_rate_Hz=10"}}};
}

TEST(Variants, EachIsItsOwnRunForAnyNumberOfThreads) {
  for (const unsigned jobs : {1U, 3U}) {
    const VariantRuns all = simulate_variants(
        warm_up().with({"output_rate_Hz=10"}), axes(), {.jobs = jobs});
    ASSERT_EQ(all.runs, 8U);
    for (std::size_t run = 0; run < all.runs; ++run) {
      std::vector<std::string> overrides;
      const std::vector<VariedValues> varied = axes();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t value = (run >> (2 - axis)) & 1U;
        overrides.insert(overrides.end(), varied[axis][value].begin(),
                         varied[axis][value].end());
      }
      const Recording own =
          simulate(warm_up().with({"output_rate_Hz=10"}).with(overrides))
              .recording;
      const std::size_t samples = own.time.size();
      ASSERT_EQ(all.time, own.time);
      ASSERT_EQ(all.columns.size(), own.columns.size());
      for (std::size_t i = 0; i < own.columns.size(); ++i)
        for (std::size_t k = 0; k < samples; ++k)
          EXPECT_EQ(all.columns[i].values[run * samples + k],
                    own.columns[i].values[k])
              << own.columns[i].name << " of run " << run;
    }
  }
}

TEST(Variants, ErrorsBeginWithTheValuesOfTheRun) {
  EXPECT_EQ(rejection([] {
              simulate_variants(
                  warm_up(), {{{"seed=1"}},
                              {{"beam.length_m=0.04"}, {"beam.length_m=-1"}}});
            }).substr(0, 33),
            "seed = 1, beam.length_m = -1: set");
  EXPECT_EQ(
      rejection([] {
        simulate_variants(warm_up(), {{{"duration_s=2"}, {"duration_s=3"}}});
      }).substr(0, 31),
      "duration_s = 3: has other times");
  EXPECT_THROW(simulate_variants(warm_up(), {{}}), std::invalid_argument);
}

TEST(Variants, ProgressMayCancel) {
  EXPECT_THROW(simulate_variants(warm_up(), {{{"seed=1"}, {"seed=2"}}},
                                 {.progress = [](double) { return false; }}),
               Cancelled);
}

}  // namespace
}  // namespace beamgyro::internal::variants_test
