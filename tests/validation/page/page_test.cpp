// SPDX-License-Identifier: MIT
#include "validation/page/page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/config/rejection.h"

namespace beamgyro::internal::page_test {

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
  EXPECT_TRUE(holds(hostile, "\\u003c/script>"));
}

TEST(ReportPage, TextThatLooksLikeAMarkOfTheTemplateIsKept) {
  const std::string page = page_of({{"words", "/* CHART.JS */"}});
  EXPECT_TRUE(holds(page, "{\"words\":\"/* CHART.JS */\"}"));
}

TEST(ReportPage, TheSameResultGivesTheSameBytes) {
  const nlohmann::ordered_json result = {{"verdict", "pass"}, {"b", 0.1}};
  EXPECT_EQ(page_of(result), page_of(nlohmann::ordered_json(result)));
}

/// The page without Chart.js, whose comments name its authors' sites.
std::string page_itself() {
  std::string page = page_of({});
  const std::size_t begin = page.find("/*!\n * Chart.js");
  const std::size_t end = page.find("</script>", begin);
  EXPECT_LT(begin, end);
  return page.erase(begin, end - begin);
}

TEST(ReportPage, NamesNothingToLoad) {
  const std::string page = page_itself();
  for (const char* loader : {"src=", "url(", "@import", "import(", "fetch(",
                             "XMLHttpRequest", "innerHTML", "eval("})
    EXPECT_FALSE(holds(page, loader)) << loader;
  // The name of SVG, which is no address to load from.
  EXPECT_EQ(occurrences(page, "http"), occurrences(page, "http-equiv") + 1);
  EXPECT_EQ(occurrences(page, "http://www.w3.org/2000/svg"), 1u);
  EXPECT_TRUE(holds(page, "default-src 'none'"));
}

TEST(ReportPage, IsSmallWithEveryFigureFull) {
  const std::vector<double> values(300, -0.123456);
  nlohmann::ordered_json result;
  for (std::size_t figure = 0; figure < 20; ++figure)
    for (std::size_t series = 0; series < 8; ++series)
      result["figures"][figure]["series"][series] = {
          {"name", "after, slow_ramp, rising"}, {"x", values}, {"y", values}};
  EXPECT_LT(page_of(result).size(), 2'000'000u);
}

}  // namespace beamgyro::internal::page_test
