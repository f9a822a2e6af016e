// SPDX-License-Identifier: MIT
#include "validation/evidence/evidence.h"

#include <gtest/gtest.h>

namespace beamgyro::internal::evidence_test {

TEST(Evidence, EveryPurposeIsFoundByItsName) {
  for (int k = 0; k <= static_cast<int>(RunPurpose::kVibration); ++k) {
    const auto purpose = static_cast<RunPurpose>(k);
    EXPECT_EQ(purpose_of(purpose_name(purpose)), purpose);
  }
  EXPECT_EQ(purpose_of("warmup"), std::nullopt);
}

TEST(Evidence, RunsAreFoundByPurposeInTheirOrder) {
  Evidence evidence;
  evidence.runs = {{"a", RunPurpose::kRest, nullptr, {}},
                   {"b", RunPurpose::kRamp, nullptr, {}},
                   {"c", RunPurpose::kRest, nullptr, {}}};
  const auto found = runs_for(evidence, {RunPurpose::kRest});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0]->name, "a");
  EXPECT_EQ(found[1]->name, "c");
}

}  // namespace beamgyro::internal::evidence_test
