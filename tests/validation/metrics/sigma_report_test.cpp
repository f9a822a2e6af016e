// SPDX-License-Identifier: MIT
#include "validation/metrics/sigma_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "compensation/uncertainty/bias_sigma.h"
#include "random/random_stream.h"
#include "tests/validation/metrics/metric_scene.h"
#include "validation/metrics/bias_filter.h"
#include "validation/metrics/sigma_evidence.h"

namespace beamgyro::internal::sigma_report_test {
namespace {

using enum RunPurpose;

constexpr RandomPurpose kDrawnBias{900};
constexpr double kLow = -40.0, kHigh = 50.0;  // [degC]
constexpr int kRuns = 150;

/// 1-sigma of the bias [deg/s], twice as large at the hot end.
double sigma_at(double T) { return 0.05 * (1.0 + (T - kLow) / (kHigh - kLow)); }

/// A bias over temperature that is drawn from the process (U.1) with the sigma
/// above, with straight lines over steps of 0.5 K.
class DrawnBias {
 public:
  explicit DrawnBias(std::uint64_t seed) {
    RandomStream random(seed, 0, 0, kDrawnBias);
    double T = kLow - 5.0, b = sigma_at(T) * random.normal();
    for (; T <= kHigh + 5.0; T += kStep) {
      values_.push_back(b);
      const auto [carried, variance] =
          bias_step(sigma_at(T), sigma_at(T + kStep), kStep);
      b = carried * b + std::sqrt(variance) * random.normal();
    }
  }

  double at(double T) const {
    const double place = (T - (kLow - 5.0)) / kStep;
    const auto k = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(k);
    return (1.0 - share) * values_.at(k) + share * values_.at(k + 1);
  }

 private:
  static constexpr double kStep = 0.5;  // [K]
  std::vector<double> values_;          // [deg/s]
};

/// Runs over soaks and over ramps, each with a bias of its own. The rate states
/// `factor` times the sigma that its bias is drawn from.
std::unique_ptr<Scene> drawn_scene(double factor) {
  auto scene = std::make_unique<Scene>();
  const auto ramp = [](double t) {
    return kLow + (kHigh - kLow) * std::min(t, 5400.0) / 5400.0;
  };
  const auto soaks = soak_temperatures({-30, -5, 20, 45}, 900);
  for (int run = 0; run < kRuns; ++run)
    for (const bool is_soak : {false, true}) {
      const SignalOfTime T = is_soak ? soaks : SignalOfTime(ramp);
      const auto seed = 2 * static_cast<std::uint64_t>(run) + (is_soak ? 1 : 0);
      const DrawnBias bias(seed);
      EvidenceRun& added =
          scene->add({is_soak ? kSoak : kRamp,
                      {.duration = is_soak ? 4500.0 : 5400.0,
                       .step = 2,
                       .bias = [&](double t) { return bias.at(T(t)); },
                       .temperature = T},
                      {{"true_ambient_temperature", T}}},
                     {0.01, 0.0, 0.0, 0.0}, seed);
      for (const double t : added.recording->time)
        added.sigma.push_back(factor * sigma_at(T(t)));
    }
  return scene;
}

/// Expects a share within 3 standard deviations of that of `n` groups.
void expect_share(const std::optional<Estimate>& found, double share,
                  std::size_t n) {
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->value, share,
              3.0 * std::sqrt(share * (1.0 - share) / static_cast<double>(n)));
}

// P(|z| <= limit / factor) of a normal z.
double normal_share(double limit, double factor) {
  return std::erf(limit / factor / std::numbers::sqrt2);
}

constexpr double kLimits[] = {0.6744897501960817, 1.6448536269514722,
                              1.959963984540054};

TEST(SigmaReport, TheRightSigmaCoversAsStatedAndTheFilterExpectsWhatComes) {
  const SigmaReport report =
      sigma_report(sigma_evidence(drawn_scene(1.0)->evidence));
  EXPECT_EQ(report.soaks.groups, 4u * kRuns);
  for (std::size_t k = 0; k < kCoverageLevels.size(); ++k) {
    // Soaks are 25 K apart: their biases correlate by 0.08. Stretches of 10 K
    // correlate by more: 4 of 9 are counted.
    expect_share(report.soaks.coverage[k], kCoverageLevels[k], 4 * kRuns);
    expect_share(report.ramps.coverage[k], kCoverageLevels[k], 4 * kRuns);
    EXPECT_LE(report.soaks.coverage[k]->interval->low, kCoverageLevels[k]);
    EXPECT_GE(report.soaks.coverage[k]->interval->high, kCoverageLevels[k]);
  }
  EXPECT_GT(report.soaks.pit->p_value, 0.01);
  ASSERT_TRUE(report.nis.has_value());
  EXPECT_NEAR(report.nis->value, 1.0, 0.1);
  EXPECT_LE(report.nis->interval->low, 1.0);
  EXPECT_GE(report.nis->interval->high, 1.0);
}

TEST(SigmaReport, ASigmaOfHalfOrTwiceTheSizeIsCaught) {
  for (const double size : {0.5, 2.0}) {
    SCOPED_TRACE(size);
    const SigmaReport report =
        sigma_report(sigma_evidence(drawn_scene(size)->evidence));
    for (std::size_t k = 0; k < kCoverageLevels.size(); ++k) {
      expect_share(report.soaks.coverage[k], normal_share(kLimits[k], 1 / size),
                   4 * kRuns);
      for (const SigmaFit* of : {&report.soaks, &report.ramps}) {
        const Interval interval = *of->coverage[k]->interval;
        if (size < 1)
          EXPECT_LT(interval.high, kCoverageLevels[k]);
        else
          EXPECT_GT(interval.low, kCoverageLevels[k]);
      }
    }
    EXPECT_LT(report.soaks.pit->p_value, 1e-6);
    if (size < 1)
      EXPECT_GT(report.nis->interval->low, 1.1);
    else
      EXPECT_LT(report.nis->interval->high, 0.9);
  }
}

TEST(SigmaReport, SoaksWithinTenKelvinsCountAsOne) {
  Scene scene;
  const auto T = soak_temperatures({0, 4, 8, 12, 30, 33}, 900);
  EvidenceRun& run = scene.add({kSoak,
                                {.duration = 6900, .step = 2, .temperature = T},
                                {{"true_ambient_temperature", T}}});
  run.sigma.assign(run.rate.size(), 1.0);
  std::vector<std::size_t> sizes;
  for (const ErrorGroup& group : soak_errors(scene.evidence))
    sizes.push_back(group.z.size());
  EXPECT_EQ(sizes, (std::vector<std::size_t>{3, 1, 2}));
}

TEST(SigmaReport, TheSameErrorsInEveryGroupOfAClusterCountAsOne) {
  std::vector<ErrorGroup> apart, together;
  for (std::size_t cluster = 0; cluster < 20; ++cluster)
    for (int copy = 0; copy < 5; ++copy) {
      const double z = cluster < 18 ? 0.5 : 3.0;
      apart.push_back({apart.size(), {z}});
      together.push_back({cluster, {z}});
    }
  const Estimate many = *coverage(apart, 0.9);
  const Estimate few = *coverage(together, 0.9);
  EXPECT_DOUBLE_EQ(many.value, 0.9);
  EXPECT_DOUBLE_EQ(few.value, 0.9);
  // Clopper and Pearson for 89.1 of 99 and for 17.1 of 19.
  EXPECT_NEAR(many.interval->low, 0.823, 2e-3);
  EXPECT_NEAR(few.interval->low, 0.675, 3e-3);
}

TEST(SigmaReport, AllOrNoneCoveredHasAnInterval) {
  std::vector<ErrorGroup> groups;
  for (std::size_t k = 0; k < 10; ++k) groups.push_back({k, {0.1}});
  const Estimate all = *coverage(groups, 0.9);
  EXPECT_EQ(all.value, 1.0);
  EXPECT_EQ(all.interval->high, 1.0);
  EXPECT_NEAR(all.interval->low, std::pow(0.025, 0.1), 1e-12);
  for (ErrorGroup& group : groups) group.z = {9.0};
  EXPECT_EQ(coverage(groups, 0.9)->value, 0.0);
  EXPECT_EQ(coverage(groups, 0.9)->interval->low, 0.0);
}

TEST(SigmaReport, PitOfEvenQuantilesIsLevel) {
  std::vector<ErrorGroup> groups;
  // z of u = 0.05, 0.15, ..., 0.95.
  for (const double z : {-1.6449, -1.0364, -0.6745, -0.3853, -0.1257, 0.1257,
                         0.3853, 0.6745, 1.0364, 1.6449})
    groups.push_back({groups.size(), {z}});
  const PitReport report = *pit_report(groups);
  for (const double share : report.histogram) EXPECT_NEAR(share, 0.1, 1e-12);
  EXPECT_NEAR(report.distance, 0.05, 1e-4);
  EXPECT_GT(report.p_value, 0.999);
}

TEST(SigmaReport, WithoutSigmaThereIsNothing) {
  Scene scene;
  scene.add({kRamp, {.temperature = [](double t) { return 0.1 * t; }}});
  EXPECT_FALSE(states_sigma(scene.evidence));
  const SigmaEvidence found = sigma_evidence(scene.evidence);
  EXPECT_TRUE(found.soaks.empty() && found.ramps.empty() &&
              found.filter.empty());
  EXPECT_FALSE(coverage({}, 0.9).has_value());
  EXPECT_FALSE(pit_report({}).has_value());
  EXPECT_FALSE(mean_normalised({}).has_value());
}

TEST(SigmaReport, SamplesWithoutAnAnswerAreLeftOut) {
  Scene scene;
  const auto T = [](double t) { return 0.02 * t; };
  EvidenceRun& run =
      scene.add({kRamp, {.duration = 1500, .step = 1, .temperature = T}});
  run.sigma.assign(run.rate.size(), 0.1);
  for (std::size_t k = 0; k < 30; ++k)
    run.rate[k] = run.sigma[k] = std::numeric_limits<double>::quiet_NaN();
  const SigmaEvidence found = sigma_evidence(scene.evidence);
  std::size_t blocks = 0;
  for (const ErrorGroup& group : found.ramps) blocks += group.z.size();
  EXPECT_EQ(blocks, 24u);
  ASSERT_EQ(found.filter.size(), 1u);
  // At 30 s, and 25 K later.
  EXPECT_EQ(found.filter[0].normalised.size(), 2u);
}

TEST(BiasFilter, MeasuresAConstantAsTheMeanOfItsMeasurements) {
  constexpr double kSigma = 0.2, kVariance = 1e-4;
  BiasFilter filter(kSigma, 20.0);
  double information = 1.0 / (kSigma * kSigma);
  for (int k = 0; k < 5; ++k) {
    filter.predict(kSigma, 20.0);
    const Innovation seen = filter.measure(0.3, kVariance);
    EXPECT_NEAR(seen.expected, 1.0 / information + kVariance, 1e-15);
    // The mean of k measurements and of the first belief, 0.
    const double mean = 0.3 * (1.0 - 1.0 / (kSigma * kSigma * information));
    EXPECT_NEAR(seen.squared, std::pow(0.3 - mean, 2), 1e-15);
    information += 1.0 / kVariance;
  }
}

TEST(BiasFilter, WithoutAMeasurementItBelievesTheStatedSigma) {
  BiasFilter filter(0.1, -20.0);
  for (const double T : {-18.0, 3.0, 44.0}) filter.predict(0.1 + 1e-3 * T, T);
  EXPECT_NEAR(filter.measure(0.0, 0.0).expected, 0.144 * 0.144, 1e-15);
}

// A long way from a measurement nothing of it is left.
TEST(BiasFilter, ForgetsOverTheCorrelationOfTheTemperature) {
  BiasFilter filter(0.1, 0.0);
  filter.measure(0.25, 0.0);
  filter.predict(0.1, kBiasCorrelation);
  const Innovation near = filter.measure(0.0, 0.0);
  EXPECT_NEAR(near.squared, std::pow(0.25 * std::exp(-1.0), 2), 1e-15);
  EXPECT_NEAR(near.expected, 0.01 * (1.0 - std::exp(-2.0)), 1e-15);
}

}  // namespace
}  // namespace beamgyro::internal::sigma_report_test
