// SPDX-License-Identifier: MIT
#include "validation/page/page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace beamgyro::page_test {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(ReportPage, TextOfUsersEndsNoScript) {
  const std::size_t scripts = occurrences(page_of({}), "</script");
  const std::string hostile =
      page_of({{"words", "</script><script>alert(1)</script><!--"},
               {"verdict", "\xff"}});
  EXPECT_EQ(occurrences(hostile, "</script"), scripts);
  EXPECT_EQ(occurrences(hostile, "<!--"), occurrences(page_of({}), "<!--"));
  EXPECT_NE(hostile.find("\\u003c/script>"), std::string::npos);
}

TEST(ReportPage, TextThatLooksLikeAMarkOfTheTemplateIsKept) {
  const std::string page = page_of({{"words", "/* CHART.JS */"}});
  EXPECT_NE(page.find("{\"words\":\"/* CHART.JS */\"}"), std::string::npos);
}

TEST(ReportPage, TheSameResultGivesTheSameBytes) {
  const nlohmann::ordered_json result = {{"verdict", "pass"}, {"b", 0.1}};
  EXPECT_EQ(page_of(result), page_of(nlohmann::ordered_json(result)));
}

}  // namespace beamgyro::page_test
