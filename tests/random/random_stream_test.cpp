// SPDX-License-Identifier: MIT
#include "random/random_stream.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace beamgyro::internal::random_stream_test {
namespace {

constexpr auto kPurpose = RandomPurpose{3};

double uniform_of(std::uint32_t low, std::uint32_t high) {
  const std::uint64_t word = (std::uint64_t{high} << 32) | low;
  return std::ldexp(static_cast<double>(2 * (word >> 12) + 1), -53);
}

double normal_probability(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

std::vector<double> normals(std::size_t count, std::uint64_t seed = 7,
                            std::uint32_t device = 0, std::uint32_t run = 0,
                            RandomPurpose purpose = kPurpose) {
  std::vector<double> values(count);
  RandomStream(seed, device, run, purpose).fill_normal(values);
  return values;
}

// Published known answer of Philox4x32-10 for key and counter zero.
TEST(RandomStream, StartsWithTheKnownAnswerOfPhilox) {
  RandomStream stream(0, 0, 0, RandomPurpose{0});
  EXPECT_EQ(stream.uniform(), uniform_of(0x6627e8d5, 0xe169c58d));
  EXPECT_EQ(stream.uniform(), uniform_of(0xbc57ac4c, 0x9b00dbd8));
}

TEST(RandomStream, PutsSeedInTheKeyAndTheOtherWordsInTheCounter) {
  RandomStream stream(0x0123456789abcdefu, 42, 0xfffffffeu, RandomPurpose{8});
  const philox4x32_key_t key = {{0x89abcdefu, 0x01234567u}};
  for (std::uint32_t block = 0; block < 5; ++block) {
    const auto word =
        philox4x32_R(10, philox4x32_ctr_t{{block, 8, 42, 0xfffffffeu}}, key);
    EXPECT_EQ(stream.uniform(), uniform_of(word.v[0], word.v[1]));
    EXPECT_EQ(stream.uniform(), uniform_of(word.v[2], word.v[3]));
  }
}

TEST(RandomStream, NormalInvertsTheDistributionFunctionAtTheUniformNumber) {
  RandomStream uniform(3, 1, 4, kPurpose), normal(3, 1, 4, kPurpose);
  for (int i = 0; i < 200000; ++i) {
    const double p = uniform.uniform();
    const double z = normal.normal();
    const double tail = std::min(p, 1.0 - p);
    ASSERT_NEAR(normal_probability(-std::abs(z)), tail, 2e-14 * tail) << p;
    ASSERT_EQ(z > 0.0, p > 0.5);
  }
}

TEST(NormalQuantile, InvertsTheDistributionFunctionFarIntoTheTail) {
  for (double p = 0.4; p > 1e-300; p *= 0.37) {
    const double z = normal_quantile(p);
    // dp/p = -z dz: a relative error of 4e-16 of z grows by z^2.
    EXPECT_NEAR(normal_probability(z) / p, 1.0, 1e-15 * (2.0 + z * z)) << p;
  }
  EXPECT_EQ(normal_quantile(0.5), 0.0);
  EXPECT_EQ(normal_quantile(0.75), -normal_quantile(0.25));
}

TEST(NormalQuantile, RejectsWhatIsNoProbability) {
  for (double p : {0.0, 1.0, -0.1, 1.5, std::nan("")})
    EXPECT_THROW(normal_quantile(p), std::invalid_argument) << p;
}

TEST(RandomStream, NormalNumbersHaveTheMomentsOfTheNormalLaw) {
  constexpr std::size_t kCount = 1000000;
  double sum[5] = {};
  for (double z : normals(kCount))
    for (int m = 1; m <= 4; ++m) sum[m] += std::pow(z, m) / kCount;
  const double sigma = 1.0 / std::sqrt(kCount);  // of a mean of unit variance
  EXPECT_NEAR(sum[1], 0.0, 3.0 * sigma);
  EXPECT_NEAR(sum[2], 1.0, 3.0 * sigma * std::sqrt(2.0));
  EXPECT_NEAR(sum[3], 0.0, 3.0 * sigma * std::sqrt(15.0));
  EXPECT_NEAR(sum[4], 3.0, 3.0 * sigma * std::sqrt(96.0));
}

TEST(RandomStream, NormalNumbersPassKolmogorovAndSmirnov) {
  constexpr std::size_t kCount = 200000;
  std::vector<double> z = normals(kCount);
  std::sort(z.begin(), z.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double p = normal_probability(z[i]);
    distance = std::max({distance, p - static_cast<double>(i) / kCount,
                         static_cast<double>(i + 1) / kCount - p});
  }
  EXPECT_LT(distance * std::sqrt(kCount), 1.63);  // 1 % level
}

TEST(RandomStream, FillNormalGivesTheNumbersOfNormalHoweverCut) {
  std::vector<double> one_by_one(5000);
  const RandomStream start(0x0123456789abcdefu, 42, 0xfffffffeu, kPurpose);
  RandomStream single = start;
  for (double& z : one_by_one) z = single.normal();
  for (std::size_t piece : {1u, 3u, 255u, 256u, 257u, 1000u, 5000u}) {
    RandomStream stream = start;
    std::vector<double> filled(one_by_one.size());
    for (std::size_t i = 0; i < filled.size(); i += piece)
      stream.fill_normal(
          std::span(filled).subspan(i, std::min(piece, filled.size() - i)));
    EXPECT_EQ(filled, one_by_one) << piece;
  }
}

TEST(RandomStream, SeekGoesToAnyNumber) {
  const auto all = normals(100, 7, 0, 3);
  RandomStream stream(7, 0, 3, kPurpose);
  for (const std::uint64_t position : {0u, 1u, 2u, 57u, 58u, 13u, 99u, 0u}) {
    stream.seek(position);
    EXPECT_EQ(stream.position(), position);
    EXPECT_EQ(stream.normal(), all[position]);
    EXPECT_EQ(stream.position(), position + 1);
  }
  const std::uint64_t end = std::uint64_t{1} << 33;
  stream.seek(end);
  EXPECT_EQ(stream.position(), end);
  EXPECT_THROW(stream.normal(), std::runtime_error);
  EXPECT_THROW(stream.seek(end + 1), std::runtime_error);
}

TEST(RandomStream, DoesNotDependOnStreamsDrawnBesideIt) {
  const auto alone = normals(1000, 7, 0, 3);
  RandomStream first(7, 0, 3, kPurpose), second(7, 0, 4, kPurpose);
  for (double expected : alone) {
    second.normal();
    EXPECT_EQ(first.normal(), expected);
  }
}

TEST(RandomStream, EveryWordOfItsNameGivesAnIndependentStream) {
  constexpr std::size_t kCount = 100000;
  const auto reference = normals(kCount);
  const std::vector<std::vector<double>> others = {
      normals(kCount, 8), normals(kCount, 7 + (std::uint64_t{1} << 32)),
      normals(kCount, 7, 1), normals(kCount, 7, 0, 1),
      normals(kCount, 7, 0, 0, RandomPurpose{1})};
  for (const auto& other : others) {
    double correlation = 0.0;
    for (std::size_t i = 0; i < kCount; ++i)
      correlation += reference[i] * other[i] / kCount;
    EXPECT_LT(std::abs(correlation), 4.0 / std::sqrt(kCount));
  }
}

// They are part of the data: a number put in between moves those after it.
TEST(RandomPurpose, EachKeepsItsNumber) {
  EXPECT_EQ(kWhiteNoiseStream, 0);
  EXPECT_EQ(kInitialWeightsStream, 6);
  EXPECT_EQ(kDeviceDrawStream, 8);
  EXPECT_EQ(kSobolScrambleStream, 15);
  EXPECT_EQ(kIntervalStream, 16);
  EXPECT_EQ(kWalkSinceTrimStream, 17);
  EXPECT_EQ(kIndexResampleStream, 22);
  EXPECT_EQ(kResidualForecastStream, 25);
}

}  // namespace
}  // namespace beamgyro::internal::random_stream_test
