// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "random/random_stream.h"
#include "tests/validation/metrics/metric_scene.h"

namespace beamgyro::internal::metric_coverage_test {
namespace {

using enum RunPurpose;
using std::numbers::pi;
using MakeScene =
    std::function<Scene(const NoiseLevels& noise, std::uint64_t seed)>;

constexpr int kSeeds = 100;

/// In how many scenes the 95 % interval holds the truth.
int covered_in(const std::string& metric, double truth,
               const std::vector<Scene>& scenes) {
  int covered = 0;
  for (const Scene& scene : scenes) {
    const Estimate found = evaluated(metric, scene.evidence);
    if (!found.interval) {
      ADD_FAILURE() << metric << " has no interval";
      return 0;
    }
    const auto [low, high] = *found.interval;
    EXPECT_LE(low, found.value) << metric;
    EXPECT_GE(high, found.value) << metric;
    covered += low <= truth && truth <= high ? 1 : 0;
  }
  return covered;
}

/// Expects it in 90 to 99 of 100 seeds, which a fair 95 % interval meets with a
/// probability of 0.97.
void expect_coverage(const std::string& metric, double truth,
                     const std::vector<Scene>& scenes, int most = 99) {
  const int covered = covered_in(metric, truth, scenes);
  EXPECT_GE(covered, 90) << metric << " is " << truth;
  EXPECT_LE(covered, most) << metric << " is " << truth;
}

std::vector<Scene> scenes_of(const MakeScene& make, const NoiseLevels& noise) {
  std::vector<Scene> scenes;
  for (int seed = 1; seed <= kSeeds; ++seed)
    scenes.push_back(make(noise, static_cast<std::uint64_t>(seed)));
  return scenes;
}

/// The truth is what the same scene without noise shows.
void expect_coverage_beneath_noise(const std::vector<std::string>& metrics,
                                   const MakeScene& make,
                                   const NoiseLevels& noise = kNominalNoise) {
  const Scene quiet = make({}, 0);
  const std::vector<Scene> scenes = scenes_of(make, noise);
  for (const std::string& metric : metrics)
    expect_coverage(metric, evaluated(metric, quiet.evidence).value, scenes);
}

double bias_curve(double T) {
  return 0.4 + 0.03 * T - 4e-4 * T * T + 0.3 * std::sin(T / 12);
}

TEST(MetricCoverage, Rest) {
  expect_coverage_beneath_noise(
      {"bias_deg_per_s"}, [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        scene.add(
            {kRest,
             {.duration = 3600, .step = 2, .bias = [](double) { return 0.4; }}},
            noise, seed);
        return scene;
      });
}

TEST(MetricCoverage, Soaks) {
  const auto T = soak_temperatures({-40, -20, 0, 20, 40, 20, 0, -20, -40}, 900);
  expect_coverage_beneath_noise(
      {"bias_pp_deg_per_s", "bias_sigma_deg_per_s",
       "bias_sensitivity_deg_per_s_per_K",
       "bias_sensitivity_max_deg_per_s_per_K", "residual_mean_deg_per_s",
       "residual_sigma_deg_per_s", "residual_rms_deg_per_s",
       "residual_max_deg_per_s", "residual_pp_deg_per_s",
       "soak_hysteresis_max_deg_per_s"},
      [T](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        scene.add({kSoak,
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
        return scene;
      });
}

TEST(MetricCoverage, Ramps) {
  const auto T = [](double t) {
    const double up = std::clamp((t - 600.0) / 60.0, 0.0, 60.0);
    return -20.0 + up - std::clamp((t - 4800.0) / 60.0, 0.0, 60.0);
  };
  expect_coverage_beneath_noise(
      {"hysteresis_max_deg_per_s", "hysteresis_rms_deg_per_s"},
      [T](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        scene.add({kRamp,
                   {.duration = 9000,
                    .step = 5,
                    .bias =
                        [T](double t) {
                          const double loop =
                              0.2 * std::sin(pi * (T(t) + 20) / 60);
                          return bias_curve(T(t)) + (t < 4500 ? loop : -loop);
                        },
                    .temperature = T},
                   {{"true_ambient_temperature", T}}},
                  noise, seed);
        return scene;
      });
}

TEST(MetricCoverage, Starts) {
  expect_coverage_beneath_noise(
      {"warm_up_time_s", "power_on_drift_3_min_deg_per_s",
       "heading_error_1_min_deg", "heading_error_10_min_deg"},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        scene.add(
            {kWarmUp,
             {.duration = 5400,
              .step = 2,
              .bias = [](double t) { return 0.3 + 2.0 * std::exp(-t / 600); }}},
            noise, seed);
        return scene;
      });
}

TEST(MetricCoverage, ResidualsOfNoiseAlone) {
  const auto scenes = scenes_of(
      [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        for (int run = 0; run < 3; ++run)
          scene.add({kRest, {.duration = 3600, .step = 5}}, noise, seed);
        return scene;
      },
      kNominalNoise);
  expect_coverage("normalised_residual", 1.0, scenes);
  // Nothing is beneath the noise; 0 is an end of such an interval.
  expect_coverage("residual_rms_deg_per_s", 0.0, scenes, 100);
  expect_coverage("residual_max_deg_per_s", 0.0, scenes, 100);
}

TEST(MetricCoverage, SpreadOfPowerCycles) {
  const auto scenes = scenes_of(
      [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        scene.add(
            {kPowerCycle,
             {.duration = 5900,
              .step = 5,
              .powered = [](double t) { return std::fmod(t, 1000) < 900; }}},
            noise, seed);
        return scene;
      },
      {.angle_random_walk = 0.01, .turn_on = 0.03});
  // White noise of a mean over 900 s beside the offset.
  expect_coverage("turn_on_repeatability_deg_per_s",
                  std::hypot(0.03, 0.01 / 30), scenes);
}

TEST(MetricCoverage, StabilityInARun) {
  const MakeScene make = [](const NoiseLevels& noise, std::uint64_t seed) {
    Scene scene;
    scene.add({kRest, {.duration = 3600, .step = 2}}, noise, seed);
    return scene;
  };
  // White noise alone: N/sqrt(100 s).
  const NoiseLevels white{.angle_random_walk = 0.01};
  expect_coverage("in_run_stability_deg_per_s", 1e-3, scenes_of(make, white));
  // With the other noise: the mean square over the seeds.
  const auto scenes = scenes_of(make, kNominalNoise);
  double squares = 0.0;
  for (const Scene& scene : scenes)
    squares += std::pow(
        evaluated("in_run_stability_deg_per_s", scene.evidence).value, 2);
  expect_coverage("in_run_stability_deg_per_s", std::sqrt(squares / kSeeds),
                  scenes);
}

TEST(MetricCoverage, RateTables) {
  const auto rate = [](double t) {
    const int step = static_cast<int>(t / 20);
    return 20.0 * (step < 11 ? step : 21 - step) - 100.0;
  };
  expect_coverage_beneath_noise(
      {"scale_factor", "scale_factor_error_ppm",
       "scale_factor_nonlinearity_ppm", "scale_factor_asymmetry_ppm",
       "scale_factor_temperature_sensitivity_ppm_per_K"},
      [rate](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        for (const double T : {-30.0, 0.0, 30.0}) {
          const double error = 1e-3 + 1e-4 * T;
          scene.add({kRateTable,
                     {.duration = 440,
                      .step = 0.5,
                      .true_rate = rate,
                      .bias =
                          [=](double t) {
                            const double r = rate(t);
                            return error * r + (2 + 0.01 * T) * r * r * 1e-5;
                          },
                      .temperature = [T](double) { return T; }}},
                    noise, seed);
        }
        return scene;
      });
}

TEST(MetricCoverage, ScaleFactorRetained) {
  // A correction with white noise of its own.
  const auto rate = [](double t) { return 1.5 * std::sin(0.3 * t); };
  std::vector<Scene> scenes;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    Scene scene;
    EvidenceRun& run =
        scene.add({kRandomRate, {.duration = 600, .true_rate = rate}});
    RandomStream random(seed, 0, 0, RandomPurpose{0});
    for (double& value : run.rate)
      value = 0.99 * value + 0.05 * random.normal();
    scenes.push_back(std::move(scene));
  }
  expect_coverage("scale_factor_retained", 0.99, scenes);
  expect_coverage("scale_factor_retained_small_rates", 0.99, scenes);
}

TEST(MetricCoverage, WhiteNoiseRatio) {
  std::vector<Scene> scenes;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    Scene scene;
    EvidenceRun& run = scene.add({kRest, {.duration = 1200, .step = 0.5}},
                                 {.angle_random_walk = 0.03}, seed);
    RandomStream random(seed, 1, 0, RandomPurpose{0});
    for (double& value : run.rate)
      value += 0.03 * std::sqrt(2.0) * random.normal();
    scenes.push_back(std::move(scene));
  }
  // Two equal and independent noises.
  expect_coverage("white_noise_ratio", std::sqrt(2.0), scenes);
}

TEST(MetricCoverage, NoiseCoefficients) {
  const MakeScene make = [](const NoiseLevels& noise, std::uint64_t seed) {
    Scene scene;
    scene.add({kRest, {.duration = 7200, .step = 0.5}}, noise, seed);
    return scene;
  };
  const double root_hour = 60;
  expect_coverage("angle_random_walk_deg_per_sqrt_h", 0.01 * root_hour,
                  scenes_of(make, {.angle_random_walk = 0.01}));
  expect_coverage(
      "rate_random_walk_deg_per_h_per_sqrt_h", 2e-3 * 3600 * root_hour,
      scenes_of(make, {.angle_random_walk = 0.01, .rate_random_walk = 2e-3}));
  // At 2 Hz the bank's poles above the Nyquist frequency fold into white noise;
  // what it shows over 100 s and more is B.
  expect_coverage(
      "bias_instability_deg_per_h", 0.02 * 3600,
      scenes_of(make, {.angle_random_walk = 0.005, .bias_instability = 0.02}));
}

TEST(MetricCoverage, RateRamp) {
  const double ramp = 5e-5;  // [deg/s2]
  expect_coverage("rate_ramp_deg_per_h_per_h", ramp * 3600 * 3600,
                  scenes_of(
                      [ramp](const NoiseLevels& noise, std::uint64_t seed) {
                        Scene scene;
                        scene.add(
                            {kRest,
                             {.duration = 7200,
                              .step = 0.5,
                              .bias = [ramp](double t) { return ramp * t; }}},
                            noise, seed);
                        return scene;
                      },
                      {.angle_random_walk = 0.01, .bias_instability = 0.005}));
}

// The angle is rounded to steps of sqrt(12) Q.
TEST(MetricCoverage, Quantisation) {
  const double Q = 0.03;  // [deg]
  const double step = Q * std::sqrt(12.0);
  std::vector<Scene> scenes;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
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
    scenes.push_back(std::move(scene));
  }
  expect_coverage("quantisation_deg", Q, scenes);
}

// The lowest deviation of the noise itself, N sqrt(1/tau) at 2 K^-1 N: of
// octaves of 0.5 s that at 8 s.
TEST(MetricCoverage, LowestAllanDeviation) {
  const double N = 0.01, K = 2e-3;
  const double variance = N * N / 8 + K * K * 8 / 3;
  expect_coverage(
      "bias_instability_bound_deg_per_h",
      3600 * std::sqrt(variance / (2 * std::numbers::ln2 / pi)),
      scenes_of(
          [](const NoiseLevels& noise, std::uint64_t seed) {
            Scene scene;
            scene.add({kRest, {.duration = 1800, .step = 0.5}}, noise, seed);
            return scene;
          },
          {.angle_random_walk = N, .rate_random_walk = K}));
}

TEST(MetricCoverage, Tumble) {
  const auto scenes = scenes_of(
      [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        scene.add(tumble_run(0, {0.02, 0.01, 0.005}), noise, seed);
        return scene;
      },
      kNominalNoise);
  // The same figure of three axes: 300 intervals.
  const int covered =
      covered_in("g_sensitivity_x_deg_per_s_per_g", 0.02, scenes) +
      covered_in("g_sensitivity_y_deg_per_s_per_g", 0.01, scenes) +
      covered_in("g_sensitivity_z_deg_per_s_per_g", 0.005, scenes);
  EXPECT_GE(covered, 270);
  EXPECT_LE(covered, 297);
}

TEST(MetricCoverage, Vibration) {
  expect_coverage_beneath_noise(
      {"vibration_rectification_deg_per_s_per_g2", "cross_axis_percent"},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        const auto y = [](double t) { return 5 * std::sin(2 * pi * t / 100); };
        const auto turn = [](double t) {
          return t < 900 ? 0.0 : t < 1200 ? 60.0 : t < 1500 ? -60.0 : 0.0;
        };
        Scene scene;
        scene.add({kVibration,
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
        return scene;
      });
}

TEST(MetricCoverage, FrequencyResponse) {
  expect_coverage_beneath_noise(
      {"bandwidth_Hz", "phase_lag_90_deg_Hz"},
      [](const NoiseLevels& noise, std::uint64_t seed) {
        Scene scene;
        for (const double f : {1.0, 8.0, 12.0, 14.0, 18.0, 22.0}) {
          const double lag = 2 * std::atan(f / 20);
          const double gain = 1 / (1 + f * f / 400);
          const auto sine = [f](double t) {
            return 5 * std::sin(2 * pi * f * t);
          };
          scene.add({kSineRate,
                     {.duration = 4,
                      .step = 0.005,
                      .true_rate = sine,
                      .bias =
                          [=](double t) {
                            return gain * 5 * std::sin(2 * pi * f * t - lag) -
                                   sine(t);
                          }}},
                    noise, seed);
        }
        return scene;
      });
}

TEST(MetricCoverage, AddedDelay) {
  for (const bool sine : {true, false}) {
    const auto rate = [sine](double t) {
      return sine ? 5 * std::sin(2 * pi * 2 * t)
                  : 10 * std::sin(0.7 * t) + 8 * std::sin(1.9 * t + 1) +
                        6 * std::sin(2.9 * t + 2);
    };
    std::vector<Scene> scenes;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      Scene scene;
      EvidenceRun& run = scene.add({sine ? kSineRate : kRandomRate,
                                    {.duration = sine ? 20.0 : 120.0,
                                     .step = sine ? 0.01 : 0.1,
                                     .true_rate = rate}});
      RandomStream random(seed, 2, 0, RandomPurpose{0});
      for (std::size_t k = 0; k < run.rate.size(); ++k)
        run.rate[k] = rate(run.recording->time[k] - 0.02) + random.normal();
      scenes.push_back(std::move(scene));
    }
    expect_coverage("added_delay_s", 0.02, scenes);
  }
}

}  // namespace
}  // namespace beamgyro::internal::metric_coverage_test
