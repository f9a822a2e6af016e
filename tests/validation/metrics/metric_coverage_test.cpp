// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "random/random_stream.h"
#include "tests/validation/metrics/metric_scene.h"
#include "validation/specification/decision.h"

namespace beamgyro::internal::metric_coverage_test {
namespace {

using enum RunPurpose;
using std::numbers::pi;
using MakeScene = std::function<Scene(std::uint64_t seed)>;
using MakeNoisyScene =
    std::function<Scene(const NoiseLevels& noise, std::uint64_t seed)>;

constexpr int kSeeds = 100;

MakeScene with_noise(const MakeNoisyScene& make, const NoiseLevels& noise) {
  return [=](std::uint64_t seed) { return make(noise, seed); };
}

struct Figure {
  std::string metric;
  double truth;
  int most = 99;  // of 100 intervals that may hold the truth
};

std::vector<Scene> scenes_of(const MakeScene& make) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    scenes.push_back(make(seed));
  return scenes;
}

/// In how many of kSeeds scenes the 95 % interval of each figure holds the
/// truth.
std::vector<int> covered_in(const std::vector<Figure>& figures,
                            const std::vector<Scene>& scenes) {
  std::vector<int> covered(figures.size());
  for (const Scene& scene : scenes) {
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const auto& [metric, truth, most] = figures[i];
      const Estimate found = evaluated(metric, scene.evidence);
      if (!found.interval) {
        ADD_FAILURE() << metric << " has no interval";
        continue;
      }
      const auto [low, high] = *found.interval;
      EXPECT_LE(low, found.value) << metric;
      EXPECT_GE(high, found.value) << metric;
      covered[i] += low <= truth && truth <= high ? 1 : 0;
    }
  }
  return covered;
}

/// Expects it in 90 to 99 of 100 seeds, which a fair 95 % interval meets with a
/// probability of 0.98. Intervals of 80 % fail with a probability of 0.994, of
/// 85 % with 0.90, and such as always hold the truth with certainty.
void expect_coverage(const std::vector<Figure>& figures,
                     const std::vector<Scene>& scenes) {
  const std::vector<int> covered = covered_in(figures, scenes);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const auto& [metric, truth, most] = figures[i];
    EXPECT_GE(covered[i], 90) << metric << " is " << truth;
    EXPECT_LE(covered[i], most) << metric << " is " << truth;
  }
}

void expect_coverage(const std::vector<Figure>& figures,
                     const MakeScene& make) {
  expect_coverage(figures, scenes_of(make));
}

/// The truth is what the same scene without noise shows. A group has metrics of
/// the same means, whose noise is drawn once for all of them.
void expect_coverage_beneath_noise(
    const std::vector<std::vector<std::string>>& groups,
    const MakeNoisyScene& make, int most = 99) {
  const Scene quiet = make({}, 0);
  const std::vector<Scene> scenes = scenes_of(with_noise(make, kNominalNoise));
  for (const std::vector<std::string>& group : groups) {
    std::vector<Figure> figures;
    for (const std::string& metric : group)
      figures.push_back(
          {metric, evaluated(metric, quiet.evidence).value, most});
    expect_coverage(figures, scenes);
  }
}

double bias_curve(double T) {
  return 0.4 + 0.03 * T - 4e-4 * T * T + 0.3 * std::sin(T / 12);
}

TEST(ManyDrawsOfMetrics, CoverABiasAtRest) {
  expect_coverage_beneath_noise(
      {{"bias_deg_per_s"}}, [](const NoiseLevels& noise, std::uint64_t seed) {
        return Scene(
            {kRest,
             {.duration = 3600, .step = 2, .bias = [](double) { return 0.4; }}},
            noise, seed);
      });
}

TEST(ManyDrawsOfMetrics, CoverTheFiguresOfSoaks) {
  const auto T = soak_temperatures({-40, -20, 0, 20, 40, 20, 0, -20, -40}, 900);
  const MakeNoisyScene make = [T](const NoiseLevels& noise,
                                  std::uint64_t seed) {
    return Scene({kSoak,
                  {.duration = 10500,
                   .step = 10,
                   .bias =
                       [T](double t) {
                         const double loop = 2e-3 * (40 - T(t));
                         return bias_curve(T(t)) + (t > 5300 ? loop : 0.0);
                       },
                   .temperature = T},
                  {{"true_ambient_temperature", T}}},
                 noise, seed);
  };
  expect_coverage_beneath_noise(
      {{"bias_pp_deg_per_s", "bias_sigma_deg_per_s",
        "bias_sensitivity_deg_per_s_per_K",
        "bias_sensitivity_max_deg_per_s_per_K"},
       {"soak_hysteresis_max_deg_per_s"},
       {"residual_mean_deg_per_s", "residual_sigma_deg_per_s",
        "residual_rms_deg_per_s", "residual_max_deg_per_s",
        "residual_pp_deg_per_s"}},
      make);
}

TEST(ManyDrawsOfMetrics, CoverTheHysteresisOfRamps) {
  expect_coverage_beneath_noise(
      {{"hysteresis_max_deg_per_s", "hysteresis_rms_deg_per_s"}},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        return Scene({kRamp,
                      {.duration = 9000,
                       .step = 5,
                       .bias =
                           [](double t) {
                             const double loop =
                                 0.2 *
                                 std::sin(pi * (ramp_temperature(t) + 20) / 60);
                             return bias_curve(ramp_temperature(t)) +
                                    (t < 4500 ? loop : -loop);
                           },
                       .temperature = ramp_temperature},
                      {{"true_ambient_temperature", ramp_temperature}}},
                     noise, seed);
      });
}

TEST(ManyDrawsOfMetrics, CoverTheFiguresOfStarts) {
  expect_coverage_beneath_noise(
      {{"warm_up_time_s"},
       {"power_on_drift_3_min_deg_per_s"},
       {"heading_error_1_min_deg"},
       {"heading_error_10_min_deg"}},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        return Scene(
            {kWarmUp,
             {.duration = 5400,
              .step = 2,
              .bias = [](double t) { return 0.3 + 2.0 * std::exp(-t / 600); }}},
            noise, seed);
      });
}

TEST(ManyDrawsOfMetrics, CoverTheHeadingAfterATurnOnThatSettles) {
  // The transient alone turns the heading by 0.03 deg/s x 200 s in 10 min.
  constexpr NoiseLevels kSettling{.angle_random_walk = 0.005,
                                  .turn_on = 0.03,
                                  .turn_on_transient = 0.03,
                                  .turn_on_settling = 200,
                                  .turn_on_recovery = 600};
  expect_coverage(
      {{"heading_error_10_min_deg", 0.05 * 600}}, [=](std::uint64_t seed) {
        const auto bias = [](double t) { return t < 10 ? 0.0 : 0.05; };
        return Scene({kPowerCycle, {.duration = 1000, .step = 5, .bias = bias}},
                     kSettling, seed);
      });
}

// Though turn-on offset and random walk are larger than it.
TEST(ManyDrawsOfMetrics, FailAResidualOfTwentyTimesItsLimit) {
  int failed = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Scene scene;
    for (int run = 0; run < 4; ++run)
      scene.add({kRamp,
                 {.duration = 40000,
                  .step = 20,
                  .bias = [](double t) { return 0.02 * std::sin(t / 500.0); }}},
                kNominalNoise, seed);
    const Limit limit{.metric = "residual_rms_deg_per_s",
                      .most = 0.02 / std::sqrt(2.0) / 20};
    failed += decide(limit, evaluated(limit.metric, scene.evidence)).result ==
                      Verdict::kFail
                  ? 1
                  : 0;
  }
  EXPECT_EQ(failed, kSeeds);
}

TEST(ManyDrawsOfMetrics, CoverResidualsOfNoiseAlone) {
  const std::vector<Scene> scenes = scenes_of([](std::uint64_t seed) {
    Scene scene;
    for (int run = 0; run < 3; ++run)
      scene.add({kRest, {.duration = 3600, .step = 5}}, kNominalNoise, seed);
    return scene;
  });
  expect_coverage({{"normalised_residual", 1.0}}, scenes);
  // Nothing is beneath the noise; 0 is an end of such an interval.
  expect_coverage({{"residual_rms_deg_per_s", 0.0, 100},
                   {"residual_max_deg_per_s", 0.0, 100}},
                  scenes);
}

TEST(ManyDrawsOfMetrics, CoverTheSpreadOfPowerCycles) {
  // White noise of a mean over 900 s beside the offset.
  expect_coverage(
      {{"turn_on_repeatability_deg_per_s", std::hypot(0.03, 0.01 / 30)}},
      [](std::uint64_t seed) {
        return Scene(
            {kPowerCycle,
             {.duration = 5900,
              .step = 5,
              .powered = [](double t) { return std::fmod(t, 1000) < 900; }}},
            {.angle_random_walk = 0.01, .turn_on = 0.03}, seed);
      });
}

TEST(ManyDrawsOfMetrics, CoverTheStabilityInARun) {
  const std::string stability = "in_run_stability_deg_per_s";
  const MakeNoisyScene make = [](const NoiseLevels& noise, std::uint64_t seed) {
    return Scene({kRest, {.duration = 3600, .step = 2}}, noise, seed);
  };
  // White noise alone: N/sqrt(100 s).
  expect_coverage({{stability, 1e-3}},
                  with_noise(make, {.angle_random_walk = 0.01}));
  // With the other noise: the mean square over the seeds.
  const std::vector<Scene> nominal = scenes_of(with_noise(make, kNominalNoise));
  double squares = 0.0;
  for (const Scene& scene : nominal)
    squares += std::pow(evaluated(stability, scene.evidence).value, 2);
  expect_coverage({{stability, std::sqrt(squares / kSeeds)}}, nominal);
}

TEST(ManyDrawsOfMetrics, CoverTheFiguresOfRateTables) {
  const MakeNoisyScene make = [](const NoiseLevels& noise, std::uint64_t seed) {
    Scene scene;
    for (const double T : {-30.0, 0.0, 30.0}) {
      const double error = 1e-3 + 1e-4 * T;
      scene.add({kRateTable,
                 {.duration = 440,
                  .step = 0.5,
                  .true_rate = table_rate,
                  .bias =
                      [=](double t) {
                        const double r = table_rate(t);
                        return error * r + (2 + 0.01 * T) * r * r * 1e-5;
                      },
                  .temperature = [T](double) { return T; }}},
                noise, seed);
    }
    return scene;
  };
  expect_coverage_beneath_noise(
      {{"scale_factor", "scale_factor_error_ppm", "scale_factor_asymmetry_ppm",
        "scale_factor_temperature_sensitivity_ppm_per_K"}},
      make);
  // Both ends of a table are as far from the line. The upper end allows for
  // each of them, so that it is hardly ever too low: 97.5 % hold the truth.
  expect_coverage_beneath_noise({{"scale_factor_nonlinearity_ppm"}}, make, 100);
}

TEST(ManyDrawsOfMetrics, CoverTheScaleFactorRetained) {
  // A correction with white noise of its own.
  const auto rate = [](double t) { return 1.5 * std::sin(0.3 * t); };
  expect_coverage({{"scale_factor_retained", 0.99},
                   {"scale_factor_retained_small_rates", 0.99}},
                  [rate](std::uint64_t seed) {
                    Scene scene;
                    EvidenceRun& run = scene.add(
                        {kRandomRate, {.duration = 600, .true_rate = rate}});
                    RandomStream random(seed, 0, 0, RandomPurpose{0});
                    for (double& value : run.rate)
                      value = 0.99 * value + 0.05 * random.normal();
                    return scene;
                  });
}

TEST(ManyDrawsOfMetrics, CoverTheWhiteNoiseRatio) {
  // Two equal and independent noises.
  expect_coverage(
      {{"white_noise_ratio", std::sqrt(2.0)}}, [](std::uint64_t seed) {
        Scene scene;
        EvidenceRun& run = scene.add({kRest, {.duration = 1200, .step = 0.5}},
                                     {.angle_random_walk = 0.03}, seed);
        RandomStream random(seed, 1, 0, RandomPurpose{0});
        for (double& value : run.rate)
          value += 0.03 * std::sqrt(2.0) * random.normal();
        return scene;
      });
}

TEST(ManyDrawsOfMetrics, CoverTheNoiseCoefficients) {
  const MakeNoisyScene make = [](const NoiseLevels& noise, std::uint64_t seed) {
    return Scene({kRest, {.duration = 1800, .step = 0.5}}, noise, seed);
  };
  const double root_hour = 60;
  expect_coverage({{"angle_random_walk_deg_per_sqrt_h", 0.01 * root_hour}},
                  with_noise(make, {.angle_random_walk = 0.01}));
  expect_coverage(
      {{"rate_random_walk_deg_per_h_per_sqrt_h", 2e-3 * 3600 * root_hour}},
      with_noise(make, {.angle_random_walk = 0.01, .rate_random_walk = 2e-3}));
  // At 2 Hz the bank's poles above the Nyquist frequency fold into white noise;
  // what it shows over 100 s and more is B.
  expect_coverage(
      {{"bias_instability_deg_per_h", 0.02 * 3600}},
      with_noise(make, {.angle_random_walk = 0.005, .bias_instability = 0.02}));
}

TEST(ManyDrawsOfMetrics, CoverTheRateRamp) {
  const double ramp = 5e-5;  // [deg/s2]
  expect_coverage({{"rate_ramp_deg_per_h_per_h", ramp * 3600 * 3600}},
                  [ramp](std::uint64_t seed) {
                    return Scene(
                        {kRest,
                         {.duration = 7200,
                          .step = 0.5,
                          .bias = [ramp](double t) { return ramp * t; }}},
                        {.angle_random_walk = 0.01, .bias_instability = 0.005},
                        seed);
                  });
}

// The angle is rounded to steps of sqrt(12) Q.
TEST(ManyDrawsOfMetrics, CoverTheQuantisation) {
  const double Q = 0.03;  // [deg]
  const double step = Q * std::sqrt(12.0);
  expect_coverage({{"quantisation_deg", Q}}, [step](std::uint64_t seed) {
    Scene scene;
    EvidenceRun& run = scene.add({kRest, {.duration = 1800, .step = 0.5}},
                                 {.angle_random_walk = 0.05}, seed);
    double angle = 0.0, rounded = 0.0;
    for (double& value : run.rate) {
      angle += 0.5 * value;
      const double next = step * std::round(angle / step);
      value = (next - rounded) / 0.5;
      rounded = next;
    }
    return scene;
  });
}

// The lowest deviation of the noise itself, N sqrt(1/tau) at 2 K^-1 N: of
// octaves of 0.5 s that at 8 s.
TEST(ManyDrawsOfMetrics, CoverTheLowestAllanDeviation) {
  const double N = 0.01, K = 2e-3;
  const double variance = N * N / 8 + K * K * 8 / 3;
  const double bound =
      3600 * std::sqrt(variance / (2 * std::numbers::ln2 / pi));
  expect_coverage(
      {{"bias_instability_bound_deg_per_h", bound}}, [=](std::uint64_t seed) {
        return Scene({kRest, {.duration = 1800, .step = 0.5}},
                     {.angle_random_walk = N, .rate_random_walk = K}, seed);
      });
}

TEST(ManyDrawsOfMetrics, CoverTheSensitivityToGravity) {
  // The same figure of three axes: 300 intervals.
  const std::vector<int> of_axes = covered_in(
      {{"g_sensitivity_x_deg_per_s_per_g", 0.02},
       {"g_sensitivity_y_deg_per_s_per_g", 0.01},
       {"g_sensitivity_z_deg_per_s_per_g", 0.005}},
      scenes_of([](std::uint64_t seed) {
        return Scene(tumble_run(0, {0.02, 0.01, 0.005}), kNominalNoise, seed);
      }));
  const int covered = of_axes[0] + of_axes[1] + of_axes[2];
  EXPECT_GE(covered, 270);
  EXPECT_LE(covered, 297);
}

TEST(ManyDrawsOfMetrics, CoverTheFiguresOfVibration) {
  expect_coverage_beneath_noise(
      {{"vibration_rectification_deg_per_s_per_g2"}, {"cross_axis_percent"}},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        const auto y = [](double t) { return 5 * std::sin(2 * pi * t / 100); };
        const auto turn = [](double t) {
          return t < 900 ? 0.0 : t < 1200 ? 60.0 : t < 1500 ? -60.0 : 0.0;
        };
        return Scene({kVibration,
                      {.duration = 2100,
                       .step = 0.5,
                       .bias =
                           [=](double t) {
                             return 0.002 * y(t) * y(t) + 0.003 * turn(t);
                           }},
                      {{"true_acceleration_y",
                        [=](double t) { return kStandardGravity * y(t); }},
                       {"true_cross_rate_x", turn}}},
                     noise, seed);
      });
}

/// A sine of 5 deg/s of true rate at `f` [Hz], which the gyro shows with that
/// gain and lag [rad].
SceneRun sine_run(double f, double gain, double lag) {
  const auto sine = [f](double t) { return 5 * std::sin(2 * pi * f * t); };
  return {
      kSineRate,
      {.duration = 4, .step = 0.005, .true_rate = sine, .bias = [=](double t) {
         return gain * 5 * std::sin(2 * pi * f * t - lag) - sine(t);
       }}};
}

TEST(ManyDrawsOfMetrics, CoverTheFrequencyResponse) {
  expect_coverage_beneath_noise(
      {{"bandwidth_Hz", "phase_lag_90_deg_Hz"}},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        for (const double f : {1.0, 8.0, 12.0, 14.0, 18.0, 22.0}) {
          const double lag = 2 * std::atan(f / 20);
          const double gain = 1 / (1 + f * f / 400);
          scene.add(sine_run(f, gain, lag), noise, seed);
        }
        return scene;
      });
}

TEST(ManyDrawsOfMetrics, CoverThePeakOfAResonance) {
  expect_coverage_beneath_noise(
      {{"response_peak_dB"}}, [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        for (const double f : {1.0, 12.0, 19.0, 20.0, 28.0}) {
          const double square = 1 - f * f / 400;
          const double lag = std::atan2(0.4 * f / 20, square);
          const double gain = 1 / std::hypot(square, 0.4 * f / 20);
          scene.add(sine_run(f, gain, lag), noise, seed);
        }
        return scene;
      });
}

TEST(ManyDrawsOfMetrics, CoverTheAddedDelay) {
  for (const bool sine : {true, false}) {
    const auto rate = [sine](double t) {
      return sine ? 5 * std::sin(2 * pi * 2 * t)
                  : 10 * std::sin(0.7 * t) + 8 * std::sin(1.9 * t + 1) +
                        6 * std::sin(2.9 * t + 2);
    };
    expect_coverage({{"added_delay_s", 0.02}}, [&](std::uint64_t seed) {
      Scene scene;
      EvidenceRun& run = scene.add({sine ? kSineRate : kRandomRate,
                                    {.duration = sine ? 20.0 : 120.0,
                                     .step = sine ? 0.01 : 0.1,
                                     .true_rate = rate}});
      RandomStream random(seed, 2, 0, RandomPurpose{0});
      for (std::size_t k = 0; k < run.rate.size(); ++k)
        run.rate[k] = rate(run.recording->time[k] - 0.02) + random.normal();
      return scene;
    });
  }
}

}  // namespace
}  // namespace beamgyro::internal::metric_coverage_test
