// SPDX-License-Identifier: MIT
#include "sim/signal/readout.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/config/rejection.h"

namespace beamgyro::internal::readout_test {
namespace {

TEST(Quantise, GivesTheNearestMultipleWithHalvesAwayFromZero) {
  EXPECT_EQ(quantise(1.124, 0.25), 1.0);
  EXPECT_EQ(quantise(1.126, 0.25), 1.25);
  EXPECT_EQ(quantise(1.125, 0.25), 1.25);
  EXPECT_EQ(quantise(-1.125, 0.25), -1.25);
  EXPECT_EQ(quantise(0.1, 0.25), 0.0);
  EXPECT_EQ(quantise(1.0 / 3.0, 0.0), 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(quantise(NAN, 0.25)));
}

TEST(Rounded, IsTheRoundingOfTheStandardLibraryBitByBit) {
  std::vector<double> values = {0.0,      0.49999999999999994,
                                0x1p51,   0x1p51 + 0.5,
                                0x1p52,   0x1p52 - 0.5,
                                0x1p53,   1e300,
                                INFINITY, NAN,
                                5e-324};
  for (int i = 0; i < 1000; ++i) {
    values.push_back(0.5 * i);
    values.push_back(std::nextafter(0.5 * i, 1e9));
    values.push_back(0.37 * i * i);
  }
  for (const double value : values) {
    for (const double signed_value : {value, -value}) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(rounded(signed_value)),
                std::bit_cast<std::uint64_t>(std::round(signed_value)))
          << signed_value;
    }
  }
}

TEST(Quantise, RejectsABadResolution) {
  EXPECT_THROW(quantise(1.0, -0.1), std::invalid_argument);
  EXPECT_THROW(quantise(1.0, NAN), std::invalid_argument);
  EXPECT_THROW(quantise(1.0, INFINITY), std::invalid_argument);
}

// 3 bits over +-4 rad/s: LSB 1 rad/s, codes -4 .. 3; 2 V/(rad/s) about 5 V.
TEST(Readout, ThreeBitsHaveEightCodes) {
  const Readout readout(4.0, 3, 2.0, 5.0);
  EXPECT_EQ(readout.lsb(), 1.0);
  const struct {
    double rate;
    int code;
    bool saturated;
  } cases[] = {{0.0, 0, false},    {0.49, 0, false},   {-0.49, 0, false},
               {0.51, 1, false},   {2.6, 3, false},    {3.4, 3, false},
               {3.6, 3, true},     {4.0, 3, true},     {17.0, 3, true},
               {-3.6, -4, false},  {-4.0, -4, false},  {-4.01, -4, true},
               {-1e300, -4, true}, {INFINITY, 3, true}};
  for (const auto& c : cases) {
    const ReadoutSample sample = readout.sample(c.rate);
    EXPECT_EQ(sample.voltage, 5.0 + 2.0 * c.code) << c.rate;
    EXPECT_EQ(sample.saturated, c.saturated) << c.rate;
  }
}

TEST(Readout, StaysWithinHalfAnLsbBelowFullScale) {
  const double full_scale = 2.6, scale_factor = 0.7;
  for (int bits : {8, 12, 16, 24}) {
    const Readout readout(full_scale, bits, scale_factor, 2.5);
    EXPECT_DOUBLE_EQ(readout.lsb(), 2.0 * full_scale / std::pow(2.0, bits));
    for (double rate = -2.6; rate < 2.58; rate += 0.00137) {
      const ReadoutSample sample = readout.sample(rate);
      const double shown = (sample.voltage - 2.5) / scale_factor;
      ASSERT_NEAR(shown, rate, 0.5 * readout.lsb() + 1e-14) << bits;
      ASSERT_FALSE(sample.saturated);
    }
  }
}

TEST(Readout, ErrorOverManyCodesHasTheVarianceOfAUniformOne) {
  const Readout readout(2.6, 16, 1.0, 0.0);
  double variance = 0.0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double rate = -2.0 + 4.0 * i / kCount;
    const double error = readout.sample(rate).voltage - rate;
    variance += error * error / kCount;
  }
  EXPECT_NEAR(variance / (readout.lsb() * readout.lsb() / 12.0), 1.0, 0.01);
}

TEST(Readout, NeverRepairsNotANumber) {
  EXPECT_TRUE(std::isnan(Readout(1.0, 16, 1.0, 0.0).sample(NAN).voltage));
}

std::string rejection_of(double full_scale, int bits, double scale,
                         double offset) {
  return rejection([&] { Readout(full_scale, bits, scale, offset); });
}

TEST(Readout, RejectsBadParameters) {
  EXPECT_EQ(rejection_of(0.0, 16, 1.0, 0.0),
            "full scale is 0 rad/s, must be above 0");
  EXPECT_EQ(rejection_of(1.0, 0, 1.0, 0.0), "ADC has 0 bits, must be 1 to 32");
  EXPECT_EQ(rejection_of(1.0, 33, 1.0, 0.0),
            "ADC has 33 bits, must be 1 to 32");
  EXPECT_EQ(rejection_of(1.0, 16, 0.0, 0.0),
            "scale factor is 0 V/(rad/s), must not be 0");
  EXPECT_EQ(rejection_of(1.0, 16, 1.0, NAN),
            "output offset is nan V, must be finite");
}

}  // namespace
}  // namespace beamgyro::internal::readout_test
