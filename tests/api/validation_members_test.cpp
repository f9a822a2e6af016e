// SPDX-License-Identifier: MIT
#include "api/validation_members.h"

#include <gtest/gtest.h>

#include <set>

#include "include/beamgyro/option_error.h"

namespace beamgyro::internal::validation_members_test {
namespace {

TEST(ValidationMembers, EveryNameIsThereOnce) {
  std::set<std::string_view> names, keywords, options, keys;
  for (const ValidationMember& row : validation_members()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(keywords.insert(row.python).second) << row.python;
    EXPECT_TRUE(row.option.empty() || options.insert(row.option).second);
    EXPECT_TRUE(row.bundle_key.empty() || keys.insert(row.bundle_key).second);
    EXPECT_TRUE(row.option.empty() || !row.help.empty()) << row.name;
    EXPECT_FALSE(subject_names(row).empty()) << row.name;
    EXPECT_FALSE(is_given(row, {})) << row.name;
  }
  for (const ValidationMember& row : validation_members())
    EXPECT_TRUE(row.needs.empty() || names.contains(row.needs)) << row.name;
}

TEST(ValidationMembers, OneSubjectAndWhatGoesWithIt) {
  ValidationOptions options;
  EXPECT_THROW(require_sound(options), std::invalid_argument);
  options.recordings = {"a.h5", "b.h5"};
  options.full_scale = 100.0;
  EXPECT_NO_THROW(require_sound(options));
  options.campaign = "campaign.toml";
  EXPECT_THROW(require_sound(options), OptionError);
}

TEST(ValidationMembers, OwnMetricsAreOfOneCompensatorOnOneSetOfRuns) {
  ValidationOptions options;
  options.device =
      Device::read(std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml");
  options.qualification = "qualification.toml";
  ValidationOptions table = options, function = options;
  table.own_metrics = "own.csv";
  function.metrics = {{"mine", "1", [](const auto&) { return 1.0; }}};
  EXPECT_NO_THROW(require_sound(table));
  EXPECT_NO_THROW(require_sound(function));
  table.seed = function.seed = 3;
  EXPECT_NO_THROW(require_sound(table));
  for (ValidationOptions* one : {&table, &function}) {
    one->campaign = "campaign.toml";
    EXPECT_THROW(require_sound(*one), OptionError);
    one->campaign.reset();
    one->seeds = 2;
  }
  EXPECT_THROW(require_sound(table), OptionError);
  EXPECT_NO_THROW(require_sound(function));
  for (ValidationOptions* one : {&table, &function}) {
    one->seeds.reset();
    one->against = "other.json";
  }
  EXPECT_THROW(require_sound(table), OptionError);
  EXPECT_NO_THROW(require_sound(function));
}

TEST(ValidationMembers, AFlagIsGivenWhenItIsSet) {
  const ValidationMember& row = member_named("require_provenance");
  EXPECT_EQ(type_name(row), "flag");
  EXPECT_FALSE(is_given(row, {}));
  EXPECT_TRUE(is_given(row, {.require_provenance = true}));
}

TEST(ValidationMembers, SeedsAreWholeForEveryReaderOfJson) {
  ValidationOptions options;
  options.device =
      Device::read(std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml");
  options.qualification = "qualification.toml";
  options.seed = kLargestSeed;
  EXPECT_NO_THROW(require_sound(options));
  options.seed = kLargestSeed + 1;
  EXPECT_THROW(require_sound(options), OptionError);
  options.seed = kLargestSeed - 2;
  options.seeds = 3;
  EXPECT_NO_THROW(require_sound(options));
  options.seeds = 4;
  EXPECT_THROW(require_sound(options), OptionError);
  options.seed.reset();
  for (const std::uint32_t wrong : {0U, 10'001U}) {
    options.seeds = wrong;
    EXPECT_THROW(require_sound(options), OptionError);
  }
  options.seeds = 4;
  EXPECT_NO_THROW(require_sound(options));
  options.campaign = "campaign.toml";
  EXPECT_THROW(require_sound(options), OptionError);
  for (int k = 0; k < 100; ++k) EXPECT_LT(random_seed(), kLargestSeed / 2 + 1);
  EXPECT_NE(random_seed(), random_seed());
}

}  // namespace
}  // namespace beamgyro::internal::validation_members_test
