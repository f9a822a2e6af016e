// SPDX-License-Identifier: MIT
#include "validation/specification/specification_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "tests/config/rejection.h"
#include "validation/metrics/metric.h"

namespace beamgyro::internal::specification_file_test {
namespace {

SpecificationFile parsed(const std::string& text) {
  return parse_specification_file(text, "spec.toml");
}

const std::string kLimit =
    "residual_rms_deg_per_s = { max = 0.1, source = \"s\" }\n";

TEST(SpecificationFile, LimitsAreReadInTheirOrder) {
  const SpecificationFile file = parsed(
      "name = \"mine\"\ndescription = \"of mine\"\nfalse_accept_risk = 0.01\n"
      "[limits]\nscale_factor = { min = 0.99, max = 1.01, source = \"a\" }\n"
      "residual_mean_deg_per_s = { max = 2, absolute = true, source = \"b\" }\n"
      "[limits_relative_to.cubic]\n" +
      kLimit);
  EXPECT_EQ(file.name, "mine");
  EXPECT_EQ(file.description, "of mine");
  EXPECT_EQ(file.false_accept_risk, 0.01);
  ASSERT_EQ(file.limits.size(), 3u);
  EXPECT_EQ(file.limits[0].least, 0.99);
  EXPECT_EQ(file.limits[0].most, 1.01);
  EXPECT_TRUE(file.limits[1].absolute);
  EXPECT_EQ(file.limits[1].source, "b");
  EXPECT_EQ(file.limits[1].place, "spec.toml:6:27");
  EXPECT_EQ(file.limits[2].metric, "residual_rms_deg_per_s");
  EXPECT_EQ(file.limits[2].relative_to, "cubic");
}

TEST(SpecificationFile, TheDefaultIsTheShippedFile) {
  const SpecificationFile shipped =
      read_specification_file(BEAMGYRO_SPECS "/default.toml");
  const SpecificationFile& file = default_specification();
  EXPECT_EQ(file.text, shipped.text);
  EXPECT_EQ(file.better_than, (std::vector<std::string>{"before", "constant"}));
  EXPECT_TRUE(file.may_leave_untested);
  EXPECT_TRUE(file.limits.empty());
}

TEST(SpecificationFile, NeedsNoLimitWhereItHasToBeBetter) {
  const SpecificationFile file =
      parsed("name = \"n\"\nbetter_than = [\"before\"]\n");
  EXPECT_EQ(file.better_than, std::vector<std::string>{"before"});
  EXPECT_FALSE(file.may_leave_untested);
  EXPECT_THROW(parsed("name = \"n\"\nbetter_than = [\"cubic\"]\n"),
               std::invalid_argument);
  EXPECT_THROW(parsed("name = \"n\"\nbetter_than = [\"before\"]\n"
                      "not_tested = \"fails\"\n"),
               std::invalid_argument);
}

TEST(SpecificationFile, LimitsSayWhatTheyAskIn) {
  EXPECT_EQ(text_of(Limit{.metric = "m", .most = 0.1}), "at most 0.1");
  EXPECT_EQ(text_of(Limit{.metric = "m", .least = 1, .most = 2}), "1 to 2");
  Limit limit{.metric = "m", .most = 0.27};
  limit.relative_to = "cubic";
  EXPECT_EQ(text_of(limit), "at most 0.27 times the cubic's");
}

TEST(SpecificationFile, WhatIsWrongIsRefusedWithItsPlace) {
  const std::pair<std::string, std::string> files[] = {
      {"name = ",
       "1:8: not TOML: Error while parsing key-value pair: encountered "
       "end-of-file"},
      {"[limits]\n", "1:1: name: missing; expected a text in quotes"},
      {"name = \"a\"\n", "1:1: limits: empty, must limit one metric or more"},
      {"name = \"a\"\n[limit]\n",
       "2:2: limit: unknown key; did you mean 'limits'?"},
      {"name = \"a\"\n[limits]\nresidual_rms_deg_per_h = 1\n",
       "3:26: limits.residual_rms_deg_per_h: not a metric; did you mean "
       "'residual_rms_deg_per_s'?"},
      {"name = \"a\"\n[limits]\nspeed = { max = 1 }\n",
       "3:9: limits.speed: not a metric; the table of validate names all of "
       "them"},
      {"name = \"a\"\n[limits]\nscale_factor = 1\n",
       "3:16: limits.scale_factor: 1 is wrong here; expected a table"},
      {"name = \"a\"\n[limits]\nscale_factor = { source = \"s\" }\n",
       "3:16: limits.scale_factor: no limit; must have max, min or both"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = 1 }\n",
       "3:16: limits.scale_factor.source: missing; expected a text in quotes"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = 1, source = \"\" }\n",
       "3:36: limits.scale_factor.source: empty, must say where the number "
       "comes from"},
      {"name = \"a\"\n[limits]\nscale_factor = { min = 2, max = 1, source = "
       "\"s\" }\n",
       "3:24: limits.scale_factor.min: 2 is above max = 1, must be at most "
       "that"},
      {"name = \"a\"\n[limits]\nscale_factor = { maximum = 1, source = \"s\" "
       "}\n",
       "3:16: limits.scale_factor: no limit; must have max, min or both"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = 1, sorce = \"s\" }\n",
       "3:16: limits.scale_factor.source: missing; expected a text in quotes; "
       "there is a 'sorce' in line 3"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = \"1\", source = \"s\" "
       "}\n",
       "3:24: limits.scale_factor.max: \"1\" is wrong here; expected a finite "
       "number"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = nan, source = \"s\" }\n",
       "3:24: limits.scale_factor.max: nan is not finite; expected a finite "
       "number"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = 1, absolute = 1, source "
       "= \"s\" }\n",
       "3:38: limits.scale_factor.absolute: 1 is wrong here; expected true or "
       "false"},
      {"name = \"a\"\nfalse_accept_risk = 0\n",
       "2:21: false_accept_risk: 0 is out of range; expected a number in (0, "
       "0.5]"},
      {"name = \"a\"\nfalse_accept_risk = 0.6\n",
       "2:21: false_accept_risk: 0.6 is out of range; expected a number in (0, "
       "0.5]"},
      {"name = \"a\"\n[limits_relative_to.raw]\n",
       "2:21: limits_relative_to.raw: unknown key; [limits_relative_to] takes "
       "before, constant, cubic, spline, straight_lines"},
      {"name = \"a\"\n[limits]\nscale_factor = { max = 1, source = \"s\" "
       "}\nscale_factor = { max = 2, source = \"s\" }\n",
       "4:16: not TOML: Error while parsing key-value pair: cannot redefine "
       "existing table 'scale_factor'"}};
  for (const auto& file : files)
    EXPECT_EQ(rejection([&] { parsed(file.first); }),
              "spec.toml:" + file.second)
        << file.first;
}

TEST(SpecificationFile, AMissingFileIsNamed) {
  EXPECT_THROW(read_specification_file("no/such/spec.toml"),
               std::invalid_argument);
}

TEST(SpecificationFile, ShippedOnesAreReadAndNameTheirSources) {
  for (const auto& entry :
       std::filesystem::directory_iterator(BEAMGYRO_SPECS)) {
    const SpecificationFile file = read_specification_file(entry.path());
    EXPECT_EQ(file.name, entry.path().stem());
    for (const Limit& limit : file.limits) {
      EXPECT_NE(find_metric(limit.metric), nullptr) << limit.metric;
      EXPECT_GT(limit.source.size(), 20u) << limit.place;
    }
  }
}

}  // namespace
}  // namespace beamgyro::internal::specification_file_test
