// SPDX-License-Identifier: MIT
#include "compensation/scoring/equivalent_freedom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "compensation/scoring/allan_deviation.h"
#include "tests/compensation/scoring/noise_samples.h"

namespace beamgyro::internal::equivalent_freedom_test {
namespace {

using enum DeviationKind;
using enum NoiseType;

/// 1/freedom = (a0 - a1/r)/r with r = starts/m, for many starts.
struct Published {
  DeviationKind kind;
  NoiseType type;
  double a0, a1;
};

// Greenhall and Riley (2003), tables 1 (modified) and 2.
const std::vector<Published> kTables{
    {kMdev, kQuantisation, 7.0 / 9.0, 1.0 / 2.0},
    {kMdev, kWhite, 1.033, 0.607},
    {kMdev, kFlicker, 1.048, 0.534},
    {kMdev, kRandomWalk, 1.302, 0.535},
    {kOadev, kWhite, 2.0 / 3.0, 1.0 / 3.0},
    {kOadev, kFlicker, 0.852, 0.375},
    {kOadev, kRandomWalk, 1.079, 0.368},
    {kOhdev, kWhite, 7.0 / 9.0, 1.0 / 2.0},
    {kOhdev, kFlicker, 0.997, 0.617},
    {kOhdev, kRandomWalk, 1.033, 0.607},
    {kOhdev, kFlickerWalk, 1.053, 0.553},
    {kOhdev, kRandomRun, 1.302, 0.535}};

TEST(EquivalentFreedom, IsThatOfThePublishedTables) {
  for (const auto& [kind, type, a0, a1] : kTables)
    for (const double r : {10.0, 100.0}) {
      const double m = 500.0;
      const double samples =
          (r + (kind == kMdev ? 3 : order_of(kind))) * m - 1.0;
      // The fit of the tables is good to 1 %, the lags taken here too.
      EXPECT_NEAR(
          equivalent_freedom(kind, type, m, samples) * (a0 - a1 / r) / r, 1.0,
          0.02)
          << name_of(kind) << " of " << name_of(type) << ", r = " << r;
    }
}

// Neighbouring second differences of independent angles have the correlations
// -2/3 and 1/6, and those m apart in the overlapping deviation alone.
TEST(EquivalentFreedom, OfQuantisationCountsTheAnglesInCommon) {
  const double m = 50.0, samples = 10000.0, starts = samples - 2.0 * m + 1.0;
  const double inverse = (1.0 + 2.0 * 4.0 / 9.0 * (1.0 - m / starts) +
                          2.0 / 36.0 * (1.0 - 2.0 * m / starts)) /
                         starts;
  EXPECT_NEAR(equivalent_freedom(kOadev, kQuantisation, m, samples) * inverse,
              1.0, 1e-9);
}

TEST(EquivalentFreedom, OfTotdevIsThatOfNistSp1065) {
  EXPECT_DOUBLE_EQ(equivalent_freedom(kTotdev, kWhite, 100, 1000), 15.0);
  EXPECT_DOUBLE_EQ(equivalent_freedom(kTotdev, kFlicker, 100, 1000),
                   11.7 - 0.22);
  EXPECT_DOUBLE_EQ(equivalent_freedom(kTotdev, kRandomWalk, 100, 1000),
                   9.3 - 0.36);
  EXPECT_EQ(expected_ratio(kTotdev, kRandomWalk, 100, 1000), 1.0 - 0.075);
  EXPECT_EQ(expected_ratio(kOadev, kRandomWalk, 100, 1000), 1.0);
}

// Quantiles of chi-squared with ten degrees of freedom: 3.24697, 20.48318.
TEST(EquivalentFreedom, MakesAnIntervalOfChiSquared) {
  const auto [low, high] = confidence_interval(2.0, 10.0);
  EXPECT_NEAR(low, 2.0 * std::sqrt(10.0 / 20.48318), 1e-6);
  EXPECT_NEAR(high, 2.0 * std::sqrt(10.0 / 3.24697), 2e-6);
}

using Make = std::vector<double> (NoiseSamples::*)() const;

/// Share of 150 records whose intervals hold the mean square over all records.
/// That of totdev is for the square of adev, about which it is biased.
void expect_coverage(Make make, const char* what) {
  constexpr std::uint32_t kRecords = 150;
  const std::vector<DeviationKind> kinds{kAdev, kOadev, kMdev,
                                         kHdev, kOhdev, kTotdev};
  std::vector<std::vector<DeviationSeries>> records;
  for (std::uint32_t run = 0; run < kRecords; ++run) {
    const EvenSeries series =
        series_of((NoiseSamples(1024, 0.1, run).*make)(), 0.1);
    records.push_back(deviation_curves(series, kinds, octave_taus(series)));
  }
  for (std::size_t c = 0; c < kinds.size(); ++c) {
    double covered = 0.0, intervals = 0.0;
    const std::size_t reference = kinds[c] == kTotdev ? 1 : c;
    for (std::size_t i = 0; i < records[0][c].points.size(); ++i) {
      double square = 0.0;
      for (const auto& curves : records)
        square += std::pow(curves[reference].points[i].deviation, 2) / kRecords;
      for (const auto& curves : records) {
        const auto& [low, high] = curves[c].points[i].interval;
        covered += low * low <= square && square <= high * high;
        intervals += 1.0;
      }
    }
    EXPECT_GE(covered, 0.92 * intervals) << what << ", " << name_of(kinds[c]);
    EXPECT_LE(covered, 0.985 * intervals) << what << ", " << name_of(kinds[c]);
  }
}

TEST(ManyDrawsOfDeviations, IntervalsHoldTheDeviationIn95OfAHundredRecords) {
  expect_coverage(&NoiseSamples::quantisation, "quantisation");
  expect_coverage(&NoiseSamples::white, "white");
  expect_coverage(&NoiseSamples::flicker, "flicker");
  expect_coverage(&NoiseSamples::random_walk, "random walk");
}

}  // namespace
}  // namespace beamgyro::internal::equivalent_freedom_test
