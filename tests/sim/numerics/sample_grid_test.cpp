// SPDX-License-Identifier: MIT
#include "sim/numerics/sample_grid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beamgyro::internal::sample_grid_test {
namespace {

TEST(SampleGrid, FindsTheFirstSampleFromATimeOn) {
  // Of these rates k / rate x rate often is not k.
  for (const double rate : {10.0, 0.3, 7.3, 1e5 / 3}) {
    const SampleGrid grid{rate, 1000};
    for (std::size_t k = 1; k < grid.count; ++k) {
      EXPECT_EQ(grid.first_from(grid.time(k)), k);
      EXPECT_EQ(grid.first_from(std::nextafter(grid.time(k), 0.0)), k);
      EXPECT_EQ(grid.first_from(std::nextafter(grid.time(k), 1e9)), k + 1);
    }
    EXPECT_EQ(grid.first_from(-1), 0);
    EXPECT_EQ(grid.first_from(0), 0);
    EXPECT_EQ(grid.first_from(1e12), 1000);
    EXPECT_EQ(grid.times(7, 2),
              (std::vector<double>{grid.time(7), grid.time(8)}));
  }
}

}  // namespace
}  // namespace beamgyro::internal::sample_grid_test
