// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "validation/metrics/metric.h"

namespace beamgyro::internal::metric_table_test {
namespace {

TEST(MetricTable, EveryTitleIsThereOnceInWordsAndWithoutItsUnit) {
  std::set<std::string> titles;
  for (const Metric& metric : metrics()) {
    const std::string title(metric.title);
    EXPECT_FALSE(title.empty()) << metric.name;
    EXPECT_TRUE(titles.insert(title).second) << title;
    EXPECT_EQ(title.find_first_of("_/"), std::string::npos) << title;
    for (const char* part :
         {" deg", " per ", " ppm", " Hz", " percent", " pp", " max", " nis"})
      EXPECT_EQ(title.find(part), std::string::npos) << title;
    EXPECT_LE(title.size(), 50U) << title;
  }
}

TEST(MetricTable, TheBestValueIsThatOfAPerfectCompensator) {
  const auto shortfall = [](const char* name, double value) {
    return shortfall_of(*find_metric(name), value);
  };
  EXPECT_EQ(shortfall("bias_deg_per_s", -0.5), 0.5);
  EXPECT_EQ(shortfall("scale_factor", 0.75), 0.25);
  EXPECT_EQ(shortfall("scale_factor", 1.25), 0.25);
  EXPECT_EQ(shortfall("sigma_coverage_90_soaks_percent", 95.0), 5.0);
  EXPECT_LT(shortfall("bandwidth_Hz", 30.0), shortfall("bandwidth_Hz", 20.0));
}

}  // namespace
}  // namespace beamgyro::internal::metric_table_test
