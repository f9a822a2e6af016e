// SPDX-License-Identifier: MIT
#include "compensation/network/random_purposes.h"

#include <gtest/gtest.h>

#include <set>

#include "planning/random_purposes.h"
#include "sensitivity/indices/random_purposes.h"
#include "sim/campaign/random_purposes.h"
#include "sim/scenario/random_purposes.h"
#include "sim/signal/random_purposes.h"
#include "validation/metrics/random_purposes.h"

namespace beamgyro::internal::random_purposes_test {
namespace {

TEST(RandomPurposes, AreAllDifferentAndWhatTheyWere) {
  const RandomPurpose all[] = {kWhiteNoiseStream,
                               kFlickerStream,
                               kRateRandomWalkStream,
                               kTurnOnStream,
                               kTemperatureSensorStream,
                               kRateProfileStream,
                               kInitialWeightsStream,
                               kSampleOrderStream,
                               kDeviceDrawStream,
                               kMechanicalNoiseStream,
                               kCrossRateXStream,
                               kCrossRateYStream,
                               kAccelerationXStream,
                               kAccelerationYStream,
                               kAccelerationZStream,
                               kSobolScrambleStream,
                               kIntervalStream,
                               kWalkSinceTrimStream,
                               kTurnOnTransientStream,
                               kQuadratureNoiseStream,
                               kDriveFrequencyNoiseStream,
                               kDriveVoltageNoiseStream,
                               kIndexResampleStream,
                               RandomPurpose{23},  // nothing draws from it
                               kRankSampleStream,
                               kResidualForecastStream};
  std::uint32_t number = 0;
  for (const RandomPurpose purpose : all)
    EXPECT_EQ(static_cast<std::uint32_t>(purpose), number++);
}

}  // namespace
}  // namespace beamgyro::internal::random_purposes_test
