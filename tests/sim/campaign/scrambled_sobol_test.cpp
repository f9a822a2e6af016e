// SPDX-License-Identifier: MIT
#include "sim/campaign/scrambled_sobol.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <stdexcept>

#include "random/random_stream.h"

namespace beamgyro::internal::scrambled_sobol_test {
namespace {

// Joe and Kuo's generator, in 1/1024; scipy.stats.qmc.Sobol 1.10 without
// scrambling gives the same.
TEST(ScrambledSobol, UnscrambledPointsAreThePublishedOnes) {
  struct Point {
    std::uint32_t index;
    std::array<std::uint64_t, 6> at;  // of dimensions 0, 1, 2, 3, 7, 19
  };
  constexpr std::array<Point, 9> kPoints = {
      {{0, {0, 0, 0, 0, 0, 0}},
       {1, {512, 512, 512, 512, 512, 512}},
       {2, {768, 256, 256, 256, 768, 256}},
       {3, {256, 768, 768, 768, 256, 768}},
       {4, {384, 384, 640, 896, 896, 128}},
       {5, {896, 896, 128, 384, 384, 640}},
       {8, {192, 320, 960, 448, 960, 320}},
       {100, {424, 264, 792, 744, 488, 344}},
       {1000, {225, 99, 531, 693, 921, 743}}}};
  constexpr std::array<std::size_t, 6> kDimensions = {0, 1, 2, 3, 7, 19};
  const ScrambledSobol sobol(20, 1);
  for (const Point& point : kPoints) {
    for (std::size_t i = 0; i < kDimensions.size(); ++i) {
      EXPECT_EQ(sobol.digits(point.index, kDimensions[i]), point.at[i] << 54)
          << point.index << ' ' << kDimensions[i];
    }
  }
}

TEST(ScrambledSobol, EachOfEqualBinsHoldsOnePoint) {
  constexpr std::size_t kDimensions = 19;
  const ScrambledSobol sobol(kDimensions, 42);
  for (const std::uint32_t points : {1u, 2u, 16u, 1024u}) {
    for (std::size_t d = 0; d < kDimensions; ++d) {
      std::set<int> bins;
      for (std::uint32_t i = 0; i < points; ++i)
        bins.insert(static_cast<int>(sobol.at(i, d) * points));
      EXPECT_EQ(bins.size(), points) << "dimension " << d;
      EXPECT_GE(*bins.begin(), 0);
      EXPECT_LT(*bins.rbegin(), static_cast<int>(points));
    }
  }
}

// Dimensions 0 and 1 are a (0, 10, 2)-net: one point in each of the 1024
// rectangles of any shape 2^-a x 2^-(10-a), scrambled or not.
TEST(ScrambledSobol, TwoDimensionsFillRectanglesOfEveryShape) {
  const ScrambledSobol sobol(2, 5);
  for (int a = 0; a <= 10; ++a) {
    std::set<std::pair<int, int>> boxes;
    for (std::uint32_t i = 0; i < 1024; ++i) {
      boxes.insert({static_cast<int>(std::ldexp(sobol.at(i, 0), a)),
                    static_cast<int>(std::ldexp(sobol.at(i, 1), 10 - a))});
    }
    EXPECT_EQ(boxes.size(), 1024u) << a;
  }
}

// Points that agree in m digits and differ in the next do so when scrambled.
TEST(ScrambledSobol, ScramblingIsNested) {
  const ScrambledSobol sobol(3, 9);
  const auto first_difference = [](std::uint64_t a, std::uint64_t b) {
    return std::countl_zero(a ^ b);
  };
  const auto scrambled = [&](std::uint32_t i, std::size_t d) {
    return static_cast<std::uint64_t>(std::ldexp(sobol.at(i, d), 53)) << 11;
  };
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      for (const std::uint32_t j : {i + 1, i + 64, 4'000'000'000u - i}) {
        EXPECT_EQ(first_difference(scrambled(i, d), scrambled(j, d)),
                  first_difference(sobol.digits(i, d), sobol.digits(j, d)));
      }
    }
  }
}

TEST(ScrambledSobol, PointsDependOnSeedAndIndexAlone) {
  const ScrambledSobol sobol(4, 7), again(6, 7), other(4, 8);
  const double last = sobol.at(1000, 3);
  EXPECT_NE(sobol.at(999, 3), last);
  EXPECT_EQ(sobol.at(1000, 3), last);
  EXPECT_EQ(again.at(1000, 3), last);
  EXPECT_NE(other.at(1000, 3), last);
}

// The origin, scrambled: uniform over seeds and independent of the dimension.
TEST(ScrambledSobol, EveryPointIsUniformOverSeeds) {
  constexpr int kSeeds = 4000;
  double sum = 0, square = 0, product = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const ScrambledSobol sobol(2, static_cast<std::uint64_t>(seed));
    const double x = sobol.at(0, 0) - 0.5, y = sobol.at(0, 1) - 0.5;
    sum += x;
    square += x * x;
    product += x * y;
  }
  // Five standard errors of each.
  EXPECT_NEAR(sum / kSeeds, 0, 5 * std::sqrt(1. / 12 / kSeeds));
  EXPECT_NEAR(square / kSeeds, 1. / 12, 5 * std::sqrt(1. / 180 / kSeeds));
  EXPECT_NEAR(product / kSeeds, 0, 5. / 12 / std::sqrt(kSeeds));
}

// Integral of the product of 1 + (x - 1/2)/4 over six dimensions is 1.
TEST(ScrambledSobol, IntegratesASmoothFunctionBetterThanMonteCarlo) {
  constexpr std::size_t kDimensions = 6;
  constexpr std::uint32_t kPoints = 1024, kRepeats = 20;
  const auto error = [](const auto& coordinate) {
    double sum = 0;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      double product = 1;
      for (std::size_t d = 0; d < kDimensions; ++d)
        product *= 1 + 0.25 * (coordinate(i, d) - 0.5);
      sum += product;
    }
    return std::abs(sum / kPoints - 1);
  };
  double sobol_error = 0, random_error = 0;
  for (std::uint32_t seed = 0; seed < kRepeats; ++seed) {
    const ScrambledSobol sobol(kDimensions, seed);
    sobol_error +=
        error([&](std::uint32_t i, std::size_t d) { return sobol.at(i, d); });
    RandomStream random(seed, 0, 0, kDeviceDrawStream);
    random_error +=
        error([&](std::uint32_t, std::size_t) { return random.uniform(); });
  }
  // Monte Carlo errs by sqrt(6/192/1024) = 5.5e-3, scrambled nets by about
  // n^-3/2.
  EXPECT_LT(sobol_error * 50, random_error);
}

TEST(ScrambledSobol, MoreDimensionsThanTheTableAreRefused) {
  EXPECT_THROW(ScrambledSobol(ScrambledSobol::kMostDimensions + 1, 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::scrambled_sobol_test
