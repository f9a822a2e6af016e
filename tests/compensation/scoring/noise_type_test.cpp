// SPDX-License-Identifier: MIT
#include "compensation/scoring/noise_type.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/compensation/scoring/noise_samples.h"

namespace beamgyro::internal::noise_type_test {
namespace {

using enum NoiseType;

const NoiseSamples kSamples(1000, 0.1, 0);

TEST(NoiseType, IsFoundByTheCorrelationOfNeighbours) {
  EXPECT_EQ(noise_type({kSamples.quantisation()}, kWhite), kQuantisation);
  EXPECT_EQ(noise_type({kSamples.white()}, kFlicker), kWhite);
  EXPECT_EQ(noise_type({kSamples.flicker()}, kWhite), kFlicker);
  EXPECT_EQ(noise_type({kSamples.random_walk()}, kWhite), kRandomWalk);
  auto run = kSamples.random_walk();
  for (std::size_t k = 1; k < run.size(); ++k) run[k] += run[k - 1];
  EXPECT_EQ(noise_type({run}, kWhite), kRandomRun);
}

TEST(NoiseType, IsNotThatOfARampUnderIt) {
  auto rates = kSamples.white();
  for (std::size_t k = 0; k < rates.size(); ++k)
    rates[k] += 10.0 * static_cast<double>(k);
  EXPECT_EQ(noise_type({rates}, kFlicker), kWhite);
}

TEST(NoiseType, NeedsNeitherEveryAverageNorOneStretch) {
  auto rates = kSamples.white();
  for (std::size_t k = 0; k < rates.size(); k += 5) rates[k] = NAN;
  EXPECT_EQ(noise_type({rates}, kFlicker), kWhite);
  auto other = NoiseSamples(1000, 0.1, 1).white();
  for (double& rate : other) rate += 1e3;  // another turn-on
  EXPECT_EQ(noise_type({kSamples.white(), other}, kFlicker), kWhite);
}

TEST(NoiseType, OfFewAveragesIsThatOfAShorterTau) {
  auto few = kSamples.white();
  few.resize(29);
  EXPECT_EQ(noise_type({few}, kRandomWalk), kRandomWalk);
  EXPECT_EQ(noise_type({std::vector<double>(1000, 2.0)}, kFlicker), kFlicker);
  auto some = kSamples.quantisation();
  some.resize(60);
  EXPECT_EQ(noise_type({some}, kWhite), kWhite);
  EXPECT_EQ(noise_type({some}, kQuantisation), kQuantisation);
}

}  // namespace
}  // namespace beamgyro::internal::noise_type_test
