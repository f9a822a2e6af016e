// SPDX-License-Identifier: MIT
#include "compensation/scoring/allan_deviation.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/compensation/recorded_run.h"
#include "tests/compensation/scoring/noise_samples.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::allan_deviation_test {
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

/// The deviations of one kind.
std::vector<AllanPoint> deviations(const std::vector<double>& rates,
                                   const char* kind,
                                   std::span<const double> taus) {
  return deviation_curves(series_of(rates, 1.0),
                          std::array{deviation_kind(kind)}, taus)[0]
      .points;
}

// NIST SP 1065, table 30: at m = 1 and 2. hdev and ohdev at m = 1 are one
// number, 70.8060732 in exact fractions; the table has 70.80608 for hdev.
TEST(AllanDeviation, OfNineRatesHasTheDigitsOfNistSp1065) {
  const std::array taus{1.0, 2.0};
  const auto expect = [&](const char* kind, const std::string& one,
                          const std::string& two, int decimals) {
    const auto points = deviations(kNbs14, kind, taus);
    ASSERT_EQ(points.size(), 2U) << kind;
    EXPECT_EQ(fmt::format("{:.5f}", points[0].deviation), one) << kind;
    EXPECT_EQ(fmt::format("{:.{}f}", points[1].deviation, decimals), two)
        << kind;
  };
  expect("adev", "91.22945", "115.8082", 4);
  expect("oadev", "91.22945", "85.95287", 5);
  expect("mdev", "91.22945", "74.78849", 5);
  expect("hdev", "70.80607", "116.7980", 4);
  expect("ohdev", "70.80607", "85.61487", 5);
  expect("totdev", "91.22945", "93.90379", 5);
}

// Table 31: at m = 1, 10 and 100. hdev at m = 100 is 3.91086056e-02 in exact
// fractions; the table has 3.910860e-02.
TEST(AllanDeviation, OfAThousandRatesHasTheDigitsOfNistSp1065) {
  const auto set = nist_set();
  const std::array taus{1.0, 10.0, 100.0};
  const auto expect = [&](const char* kind,
                          const std::vector<std::string>& expected) {
    const auto points = deviations(set, kind, taus);
    ASSERT_EQ(points.size(), 3U) << kind;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(digits(points[i].deviation), expected[i]) << kind;
  };
  expect("adev", {"2.922319e-01", "9.965736e-02", "3.897804e-02"});
  expect("oadev", {"2.922319e-01", "9.159953e-02", "3.241343e-02"});
  expect("mdev", {"2.922319e-01", "6.172376e-02", "2.170921e-02"});
  expect("hdev", {"2.943883e-01", "1.052754e-01", "3.910861e-02"});
  expect("ohdev", {"2.943883e-01", "9.581083e-02", "3.237638e-02"});
  expect("totdev", {"2.922319e-01", "9.134743e-02", "3.406530e-02"});
}

TEST(AllanDeviation, OfAnUnknownKindNamesTheKnownOnes) {
  EXPECT_TRUE(holds(rejection([] { deviation_kind("tdev"); }),
                    "\"tdev\": not known; expected adev, oadev, mdev"));
}

TEST(AllanDeviation, TausAreOctavesDecadesOrAll) {
  const EvenSeries series = series_of(std::vector<double>(41, 1.0), 0.5);
  const auto in_samples = [&](TauSpacing spacing) {
    std::vector<double> m = taus_of(series, spacing);
    for (double& tau : m) tau /= 0.5;
    return m;
  };
  EXPECT_EQ(in_samples(TauSpacing::kOctave),
            (std::vector<double>{1, 2, 4, 8, 16}));
  EXPECT_EQ(in_samples(TauSpacing::kDecade),
            (std::vector<double>{1, 2, 4, 10, 20}));
  EXPECT_EQ(in_samples(TauSpacing::kAll).size(), 20U);
}

// A ramp has none; Delta^3 of the angles is 0.
TEST(AllanDeviation, OfHadamardDoesNotSeeARamp) {
  std::vector<double> ramp;
  for (int k = 0; k < 64; ++k) ramp.push_back(0.25 * k);
  const std::array taus{1.0, 4.0};
  for (const char* kind : {"hdev", "ohdev"})
    for (const AllanPoint& point : deviations(ramp, kind, taus))
      EXPECT_NEAR(point.deviation, 0.0, 1e-12) << kind;
}

// A part with a gap on each side is a record of its own to mdev and totdev; the
// gap is too short for a new stretch.
TEST(AllanDeviation, TakesPartsWithoutAGapAsRecordsOfMdevAndTotdev) {
  const auto set = nist_set();
  auto holed = set;
  for (std::size_t k = 400; k < 405; ++k) holed[k] = NAN;
  EvenSeries series = series_of(holed, 1.0);
  series.missing = 5;
  series.samples = 995;
  const std::vector<double> first(set.begin(), set.begin() + 400);
  const std::vector<double> second(set.begin() + 405, set.end());
  const std::array ten{10.0};
  for (const char* name : {"mdev", "totdev"}) {
    const DeviationKind kind = deviation_kind(name);
    const double together =
        deviation_curves(series, std::array{kind}, ten)[0].points[0].deviation;
    const double lost = kind == DeviationKind::kMdev ? 28.0 : 1.0;
    const double of_first = 400.0 - lost, of_second = 595.0 - lost;
    const double square =
        (of_first * std::pow(deviations(first, name, ten)[0].deviation, 2) +
         of_second * std::pow(deviations(second, name, ten)[0].deviation, 2)) /
        (of_first + of_second);
    EXPECT_NEAR(together, std::sqrt(square), 1e-12) << name;
  }
}

// One sample in seven lacks. White noise comes back with both Hadamard
// deviations, and intervals that are wider for the gaps.
TEST(AllanDeviation, OfHadamardBridgesGaps) {
  const auto whole = NoiseSamples(1 << 16, 1.0, 3).white();
  auto holed = whole;
  for (std::size_t k = 6; k < holed.size(); k += 7) holed[k] = NAN;
  EvenSeries series = series_of(holed, 1.0);
  series.missing = holed.size() / 7;
  const std::array taus{1.0, 8.0, 64.0};
  const auto curves = deviation_curves(
      series, std::array{DeviationKind::kHdev, DeviationKind::kOhdev}, taus);
  for (const auto& [kind, points] : curves)
    for (std::size_t i = 0; i < taus.size(); ++i) {
      EXPECT_LT(points[i].interval.low, 1.0 / std::sqrt(taus[i]));
      EXPECT_GT(points[i].interval.high, 1.0 / std::sqrt(taus[i]));
      EXPECT_LT(points[i].freedom,
                deviations(whole, name_of(kind).c_str(), taus)[i].freedom);
    }
}

TEST(AllanDeviation, CountsWholeClustersAndKnowsItsUncertainty) {
  const std::array taus{2.0, 4.0};
  const auto points = allan_curve(kNbs14, 1.0, taus).plain;
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
  const auto points = allan_curve(ramp, 0.1, taus).overlapping;
  for (const AllanPoint& point : points) {
    EXPECT_NEAR(point.deviation, 1e-3 * point.tau / std::sqrt(2.0),
                1e-12 * point.tau);
  }
}

TEST(AllanDeviation, AConstantDoesNotCostDigits) {
  auto set = nist_set();
  const std::array taus{100.0};
  const double alone = first(allan_curve(set, 1.0, taus).overlapping);
  for (double& value : set) {
    value += 1024.0;
  }
  EXPECT_NEAR(first(allan_curve(set, 1.0, taus).overlapping), alone,
              1e-12 * alone);
}

TEST(AllanDeviation, DoesNotDependOnTheUnitOfTime) {
  const auto set = nist_set();
  const std::array seconds{10.0};
  const std::array tenths{1.0};
  EXPECT_EQ(first(allan_curve(set, 1.0, seconds).overlapping),
            first(allan_curve(set, 0.1, tenths).overlapping));
}

TEST(AllanDeviation, RefusesWhatIsNoSeries) {
  const std::array one{1.0};
  const std::array half{1.5};
  const std::array long_tau{5.0};
  auto holed = kNbs14;
  holed[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      holds(rejection([&] { allan_curve(holed, 1.0, one); }), "rate 3"));
  EXPECT_THROW(allan_curve(kNbs14, 1.0, half), std::invalid_argument);
  EXPECT_THROW(allan_curve(kNbs14, 1.0, long_tau), std::invalid_argument);
  EXPECT_THROW(allan_curve(kNbs14, 0.0, one), std::invalid_argument);
  EXPECT_THROW(allan_curve(std::vector<double>{1.0}, 1.0, one),
               std::invalid_argument);
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
  const auto [plain, overlapping] = allan_curve(kNbs14, 1.0, taus);
  const auto json = to_json(
      {{DeviationKind::kAdev, plain}, {DeviationKind::kOadev, overlapping}});
  EXPECT_EQ(json.size(), 2U);
  ASSERT_EQ(json["oadev"].size(), 2U);
  const auto& point = json["adev"][1];
  EXPECT_EQ(point["tau_s"], 2.0);
  EXPECT_EQ(point["clusters"], 4U);
  EXPECT_NEAR(point["deviation"].get<double>(), 115.8082, 5e-5);
  EXPECT_EQ(point["noise"], "white");
  EXPECT_LT(point["interval"][0], point["deviation"]);
  EXPECT_GT(point["interval"][1], point["deviation"]);
  EXPECT_GT(point["freedom"], 1.0);
}

}  // namespace
}  // namespace beamgyro::internal::allan_deviation_test
