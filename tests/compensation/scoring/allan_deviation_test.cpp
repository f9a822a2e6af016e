// SPDX-License-Identifier: MIT
#include "compensation/scoring/allan_deviation.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/compensation/recorded_run.h"

namespace beamgyro::allan_deviation_test {
namespace {

const std::vector<double> kNbs14{892, 809, 823, 798, 671, 644, 883, 903, 677};

/// The 1000 numbers of NIST SP 1065, section 12.4.
std::vector<double> nist_set() {
  std::vector<double> values;
  std::int64_t n = 1234567890;
  for (int k = 0; k < 1000; ++k) {
    values.push_back(static_cast<double>(n) / 2147483647.0);
    n = 16807 * n % 2147483647;
  }
  return values;
}

std::string digits(double value) { return fmt::format("{:.6e}", value); }

double first(const std::vector<AllanPoint>& points) {
  return points.front().deviation;
}

TEST(AllanDeviation, Nbs14HasTheDigitsOfNistSp1065) {
  const std::array one{1.0};
  const std::array two{2.0};
  EXPECT_EQ(fmt::format("{:.5f}", first(adev(kNbs14, 1.0, one))), "91.22945");
  EXPECT_EQ(fmt::format("{:.4f}", first(adev(kNbs14, 1.0, two))), "115.8082");
  EXPECT_EQ(fmt::format("{:.5f}", first(oadev(kNbs14, 1.0, two))), "85.95287");
}

TEST(AllanDeviation, TheThousandPointSetHasTheDigitsOfNistSp1065) {
  const auto set = nist_set();
  const std::array taus{1.0, 10.0, 100.0};
  const auto plain = adev(set, 1.0, taus);
  EXPECT_EQ(digits(plain[0].deviation), "2.922319e-01");
  EXPECT_EQ(digits(plain[1].deviation), "9.965736e-02");
  EXPECT_EQ(digits(plain[2].deviation), "3.897804e-02");
  const auto overlapping = oadev(set, 1.0, taus);
  EXPECT_EQ(digits(overlapping[0].deviation), "2.922319e-01");
  EXPECT_EQ(digits(overlapping[1].deviation), "9.159953e-02");
  EXPECT_EQ(digits(overlapping[2].deviation), "3.241343e-02");
}

TEST(AllanDeviation, CountsWholeClustersAndKnowsItsUncertainty) {
  const std::array taus{2.0, 4.0};
  const auto points = adev(kNbs14, 1.0, taus);
  EXPECT_EQ(points[0].clusters, 4U);
  EXPECT_EQ(points[1].clusters, 2U);
  EXPECT_DOUBLE_EQ(relative_uncertainty(points[0]), 1.0 / std::sqrt(6.0));
}

TEST(AllanDeviation, TausDoubleUpToHalfTheRecord) {
  const std::vector<double> expected{0.1, 0.2, 0.4, 0.8};
  const auto taus = octave_taus(17, 0.1);
  ASSERT_EQ(taus.size(), expected.size());
  for (std::size_t i = 0; i < taus.size(); ++i) {
    EXPECT_DOUBLE_EQ(taus[i], expected[i]);
  }
}

TEST(AllanDeviation, OfARampIsItsSlopeTimesTauOverRootTwo) {
  std::vector<double> ramp;
  for (int k = 0; k < 1000; ++k) {
    ramp.push_back(1e-3 * 0.1 * k);
  }
  const auto taus = octave_taus(ramp.size(), 0.1);
  const auto points = oadev(ramp, 0.1, taus);
  for (const AllanPoint& point : points) {
    EXPECT_NEAR(point.deviation, 1e-3 * point.tau / std::sqrt(2.0),
                1e-12 * point.tau);
  }
}

TEST(AllanDeviation, AConstantDoesNotCostDigits) {
  auto set = nist_set();
  const std::array taus{100.0};
  const double alone = first(oadev(set, 1.0, taus));
  for (double& value : set) {
    value += 1024.0;
  }
  EXPECT_NEAR(first(oadev(set, 1.0, taus)), alone, 1e-12 * alone);
}

TEST(AllanDeviation, DoesNotDependOnTheUnitOfTime) {
  const auto set = nist_set();
  const std::array seconds{10.0};
  const std::array tenths{1.0};
  EXPECT_EQ(first(oadev(set, 1.0, seconds)), first(oadev(set, 0.1, tenths)));
}

TEST(AllanDeviation, RefusesWhatIsNoSeries) {
  const std::array one{1.0};
  const std::array half{1.5};
  const std::array long_tau{5.0};
  auto holed = kNbs14;
  holed[3] = std::numeric_limits<double>::quiet_NaN();
  try {
    adev(holed, 1.0, one);
    FAIL() << "a hole was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("rate 3"), std::string::npos);
  }
  EXPECT_THROW(adev(kNbs14, 1.0, half), std::invalid_argument);
  EXPECT_THROW(adev(kNbs14, 1.0, long_tau), std::invalid_argument);
  EXPECT_THROW(adev(kNbs14, 0.0, one), std::invalid_argument);
  EXPECT_THROW(adev(std::vector<double>{1.0}, 1.0, one), std::invalid_argument);
}

// y_k = k^2 of which every third is missing: means of what is there.
TEST(AllanDeviation, OfGapsIsThatOfTheMeansOfTheOthers) {
  EvenSeries series;
  series.interval = 1.0;
  series.stretches.push_back({0, 1, NAN, 9, 16, NAN, 36, 49});
  series.samples = 6;
  series.missing = 2;
  const std::array two{2.0};
  const AllanCurve curve = allan_curve(series, two);
  // Means from k = 0 ... 6: 0.5, 1, 9, 12.5, 16, 36, 42.5. White variance:
  // half of (1 + 49 + 169) / 3 at lag 1, more at lag 2.
  const double squares =
      (8.5 * 8.5 + 11.5 * 11.5 + 7.0 * 7.0 + 23.5 * 23.5 + 26.5 * 26.5) / 5.0;
  const double shares = (1.5 + 1.5 + 2.0 + 1.5 + 1.5) / 5.0;
  const double white = 219.0 / 6.0;
  EXPECT_NEAR(curve.overlapping[0].deviation,
              std::sqrt(squares / 2.0 - white * (shares - 1.0) / 2.0), 1e-9);
  EXPECT_EQ(curve.overlapping[0].clusters, 4U);
  EXPECT_GT(curve.overlapping[0].gap_noise, 1.0);
  EXPECT_GT(relative_uncertainty(curve.overlapping[0]), 1.0 / std::sqrt(6.0));
}

TEST(AllanDeviation, TakesTheLongestStretchWithPowerAndWithoutHoles) {
  Recording run = RecordedRun{
      .duration = 100.0, .step = 1.0, .powered = [](double t) {
        return t < 30.0 || t >= 40.0;
      }}.recording();
  auto& rate = run.columns[1].values;
  rate[60] = std::nan("");
  EXPECT_EQ(longest_gapless_range(run, rate), (SampleRange{61, 100}));
  for (std::size_t k = 80; k < run.time.size(); ++k) {
    run.time[k] += 1.0;
  }
  EXPECT_EQ(longest_gapless_range(run, rate), (SampleRange{0, 30}));
}

TEST(AllanDeviation, JsonHasTheKeysPromised) {
  const std::array taus{1.0, 2.0};
  const auto json =
      to_json({adev(kNbs14, 1.0, taus), oadev(kNbs14, 1.0, taus)});
  EXPECT_EQ(json.size(), 2U);
  ASSERT_EQ(json["oadev"].size(), 2U);
  const auto& point = json["adev"][1];
  EXPECT_EQ(point.size(), 3U);
  EXPECT_EQ(point["tau_s"], 2.0);
  EXPECT_EQ(point["clusters"], 4U);
  EXPECT_NEAR(point["deviation"].get<double>(), 115.8082, 5e-5);
}

}  // namespace
}  // namespace beamgyro::allan_deviation_test
