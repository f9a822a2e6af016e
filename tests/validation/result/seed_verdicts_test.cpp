// SPDX-License-Identifier: MIT
#include "validation/result/seed_verdicts.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "statistics/intervals.h"
#include "validation/result/result_json.h"

namespace beamgyro::internal::seed_verdicts_test {
namespace {

const SpecificationFile kNoLimits;

// Seeds of a multiple of 4 fail, those before them are undecided.
CompletedValidation judged(std::uint64_t seed, std::size_t) {
  CompletedValidation one;
  one.result.verdict = seed % 4 == 0   ? Verdict::kFail
                       : seed % 4 == 3 ? Verdict::kUndecided
                                       : Verdict::kPass;
  one.result.words = "Words of " + std::to_string(seed) + ".";
  one.result.metrics = {{find_metric("residual_rms_deg_per_s"),
                         Estimate{1.0, {}},
                         Estimate{static_cast<double>(seed), {}},
                         {}}};
  one.evidence.read = {{"run of " + std::to_string(seed)}};
  return one;
}

TEST(SeedVerdicts, TheFirstOfTheWorstIsShownAndEverySeedIsCounted) {
  for (const std::size_t threads : {1U, 2U, 5U}) {
    const CompletedValidation all =
        seed_verdicts({6, 8}, judged, kNoLimits, threads);
    EXPECT_EQ(all.result.verdict, Verdict::kFail);
    EXPECT_EQ(all.result.words, "4 of 8 seeds pass. Seed 8: Words of 8.");
    EXPECT_EQ(all.evidence.read[0].name, "run of 8");
    const SeedVerdicts& seeds = *all.result.seeds;
    EXPECT_EQ(seeds.shown, 8U);
    EXPECT_EQ(seeds.passed, 4U);
    EXPECT_EQ(seeds.failed, 2U);
    EXPECT_EQ(seeds.undecided, 2U);
    EXPECT_EQ(seeds.share(), 0.5);
    EXPECT_EQ(seeds.interval.low, clopper_pearson(4, 8).low);
    ASSERT_EQ(seeds.metrics.size(), 1U);
    EXPECT_EQ(seeds.metrics[0].after,
              (std::vector<double>{6, 7, 8, 9, 10, 11, 12, 13}));
    const auto json = to_json(all.result)["seeds"];
    EXPECT_EQ(json["first"], 6);
    EXPECT_EQ(json["verdicts"][1]["verdict"], "undecided");
    EXPECT_EQ(json["verdicts"][7]["seed"], 13);
  }
}

TEST(SeedVerdicts, OneOfOneAndUndecidedIsWorseThanAPass) {
  EXPECT_EQ(seed_verdicts({1, 2}, judged, kNoLimits, 3).result.verdict,
            Verdict::kPass);
  EXPECT_EQ(seed_verdicts({1, 3}, judged, kNoLimits, 3).result.verdict,
            Verdict::kUndecided);
  EXPECT_EQ(seed_verdicts({5, 1}, judged, kNoLimits, 3).result.seeds->shown,
            5U);
}

TEST(SeedVerdicts, TheFailureOfTheFirstSeedIsThrown) {
  for (const std::size_t threads : {std::size_t{1}, std::size_t{4}}) {
    const auto fails = [](std::uint64_t seed, std::size_t) {
      if (seed > 2) throw std::runtime_error(std::to_string(seed));
      return judged(seed, 1);
    };
    try {
      seed_verdicts({1, 6}, fails, kNoLimits, threads);
      ADD_FAILURE();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3");
    }
  }
}

}  // namespace
}  // namespace beamgyro::internal::seed_verdicts_test
