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

TEST(ValidationMembers, AFlagIsGivenWhenItIsSet) {
  const ValidationMember& row = member_named("require_provenance");
  EXPECT_EQ(type_name(row), "flag");
  EXPECT_FALSE(is_given(row, {}));
  EXPECT_TRUE(is_given(row, {.require_provenance = true}));
}

}  // namespace
}  // namespace beamgyro::internal::validation_members_test
