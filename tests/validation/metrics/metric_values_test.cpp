// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <set>

#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"
#include "tests/validation/metrics/metric_scene.h"

namespace beamgyro::internal::metric_values_test {
namespace {

using enum RunPurpose;
using std::numbers::pi;

/// The value, with an interval of no width: nothing here is left to chance.
void expect_exact(const std::string& metric, const Scene& scene, double value,
                  double tolerance) {
  SCOPED_TRACE(metric);
  const Estimate found = evaluated(metric, scene.evidence);
  EXPECT_NEAR(found.value, value, tolerance);
  if (found.interval) {
    EXPECT_NEAR(found.interval->low, found.value, 0.01 * tolerance);
    EXPECT_NEAR(found.interval->high, found.value, 0.01 * tolerance);
  }
}

TEST(MetricTable, NamesAreDifferentAndEveryMetricIsDescribed) {
  std::set<std::string_view> names;
  for (const Metric& metric : metrics()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_EQ(find_metric(metric.name), &metric);
    EXPECT_FALSE(metric.unit.empty()) << metric.name;
    EXPECT_TRUE(metric.definition.ends_with('.')) << metric.name;
    EXPECT_FALSE(metric.reads.empty()) << metric.name;
    EXPECT_TRUE(metric.clause.empty() || metric.clause.starts_with("12."))
        << metric.name;
  }
  EXPECT_EQ(find_metric("bias"), nullptr);
}

TEST(MetricTable, NothingIsFoundWithoutARun) {
  for (const Metric& metric : metrics())
    EXPECT_FALSE(metric.evaluate({})) << metric.name;
}

TEST(MetricValues, BiasAtRest) {
  const Scene scene({kRest, {.bias = [](double) { return 0.4; }}});
  expect_exact("bias_deg_per_s", scene, 0.4, 1e-12);
  expect_exact("residual_mean_deg_per_s", scene, 0.4, 1e-12);
  expect_exact("residual_rms_deg_per_s", scene, 0.4, 1e-12);
  expect_exact("residual_max_deg_per_s", scene, 0.4, 1e-12);
  expect_exact("residual_sigma_deg_per_s", scene, 0.0, 1e-12);
  expect_exact("residual_pp_deg_per_s", scene, 0.0, 1e-12);
}

/// Soaks up and down over a bias of 0.1 + 0.02 T, 0.03 more on the way down.
Scene soak_scene() {
  const auto T = soak_temperatures({-20, 0, 20, 40, 20, 0, -20}, 900);
  return Scene({kSoak,
                {.duration = 8100,
                 .step = 5,
                 .bias =
                     [T](double t) {
                       return 0.1 + 0.02 * T(t) + (t > 4600 ? 0.03 : 0.0);
                     },
                 .temperature = T},
                {{"true_ambient_temperature", T}}});
}

TEST(MetricValues, BiasOverTemperature) {
  const Scene scene = soak_scene();
  // From B(-20) = -0.3 on the way up to B(40) = 0.9.
  expect_exact("bias_pp_deg_per_s", scene, 1.2, 1e-12);
  // B = 0.1 + 0.02 T + d: mean T = 40/7, d = 0.03 at 20, 0 and -20.
  const double b[] = {-0.3, 0.1, 0.5, 0.9, 0.53, 0.13, -0.27};
  double mean = 0, squares = 0;
  for (const double value : b) mean += value / 7;
  for (const double value : b) squares += (value - mean) * (value - mean) / 7;
  expect_exact("bias_sigma_deg_per_s", scene, std::sqrt(squares), 1e-12);
  // Of d, sum (T - 40/7) d = -0.03 x 3 x 40/7; sum (T - 40/7)^2 = 20800/7.
  expect_exact("bias_sensitivity_deg_per_s_per_K", scene, 0.02 - 3.6 / 20800,
               1e-12);
  // At 0 degC: B(20) - B(-20) = 0.8; at 20 degC: 0.9 - 0.115.
  expect_exact("bias_sensitivity_max_deg_per_s_per_K", scene, 0.02, 1e-12);
  expect_exact("soak_hysteresis_max_deg_per_s", scene, 0.03, 1e-12);
}

TEST(MetricValues, SoaksOfALogAreFoundByItsTemperature) {
  const auto T = soak_temperatures({-20, 0, 20, 40}, 900);
  const Scene scene({kSoak,
                     {.duration = 4500,
                      .step = 5,
                      .bias = [T](double t) { return 0.02 * T(t); },
                      .temperature = T}});
  expect_exact("bias_pp_deg_per_s", scene, 1.2, 1e-12);
  expect_exact("bias_sensitivity_deg_per_s_per_K", scene, 0.02, 1e-12);
}

TEST(MetricValues, HysteresisOfARamp) {
  Scene scene;
  scene.add({kRamp,
             {.duration = 9000,
              .step = 5,
              .bias =
                  [](double t) {
                    const double T = ramp_temperature(t);
                    const double loop = 0.1 * std::sin(pi * (T + 20) / 60);
                    return 0.02 * T + (t < 4500 ? loop : -loop);
                  },
              .temperature = ramp_temperature},
             {{"true_ambient_temperature", ramp_temperature}}});
  // Half a sine of 0.2, sampled at every kelvin and drawn as lines: within the
  // sagitta 0.1 (pi/60)^2 / 8 at its top, and 1 % of its rms at the ends.
  expect_exact("hysteresis_max_deg_per_s", scene, 0.2, 2e-4);
  expect_exact("hysteresis_rms_deg_per_s", scene, 0.2 / std::sqrt(2), 2e-3);
}

TEST(MetricValues, WarmUpIsTheLongestOfThem) {
  Scene scene;
  const auto decay = [](double tau) {
    return [tau](double t) { return 0.3 + 0.5 * std::exp(-t / tau); };
  };
  scene.add({kWarmUp, {.duration = 7200, .step = 2, .bias = decay(300)}});
  scene.add({kWarmUp, {.duration = 7200, .step = 2, .bias = decay(700)}});
  // Left is 5 % after tau ln 20; the end of the run still has e^(-6840/700) =
  // 6e-5 of the change, and the first minute's curvature (60/700)^2/8 of it.
  expect_exact("warm_up_time_s", scene, 700 * std::log(20.0), 10.0);
}

TEST(MetricValues, WarmUpOfTheSimulatedGyro) {
  // physics: within 5 % of the whole change 23.8 min after power-on at 25 degC.
  ScenarioPlan scenario =
      scenario_from("[noise]\nenabled = false\n",
                    "[ambient]\nconstant_degC = 25\n", "14400", "0.5");
  Scene scene;
  scene.add(kWarmUp,
            simulated(scenario, verification_device({"readout.adc_bits=24"})));
  const Estimate found = evaluated("warm_up_time_s", scene.evidence);
  EXPECT_NEAR(found.value, 23.8 * 60, 30);
}

TEST(MetricValues, StartsFromPowerOn) {
  const auto bias = [](double t) { return 0.2 + 1e-4 * t; };
  const Scene scene({kWarmUp, {.duration = 700, .step = 0.5, .bias = bias}});
  // Means of 10 s are 1e-3 deg/s apart.
  expect_exact("power_on_drift_3_min_deg_per_s", scene, 17e-3, 1e-9);
  expect_exact("heading_error_1_min_deg", scene, 10 * 1e-3 * 21, 1e-9);
  expect_exact("heading_error_10_min_deg", scene, 10 * 1e-3 * 1830, 1e-9);
}

TEST(MetricValues, TurnOnRepeatability) {
  Scene scene;
  scene.add({kPowerCycle,
             {.duration = 5900,
              .step = 5,
              .bias =
                  [](double t) {
                    const double offsets[] = {0.1, -0.2, 0.4, 0.0, -0.1, 0.4};
                    return offsets[static_cast<int>(t / 1000)];
                  },
              .powered = [](double t) { return std::fmod(t, 1000) < 900; }}});
  const Estimate found =
      evaluated("turn_on_repeatability_deg_per_s", scene.evidence);
  // Mean 0.1, sum of squares 0 + 0.09 + 0.09 + 0.01 + 0.04 + 0.09.
  EXPECT_NEAR(found.value, std::sqrt(0.32 / 5), 1e-12);
  // Chi-squared of five degrees of freedom: 0.8312 and 12.8325.
  EXPECT_NEAR(found.interval->low, std::sqrt(0.32 / 12.8325), 1e-4);
  EXPECT_NEAR(found.interval->high, std::sqrt(0.32 / 0.831212), 1e-4);
}

TEST(MetricValues, TurnOnTimeIsThatOfTheLoops) {
  Recording recording = RecordedRun{.duration = 2, .step = 0.01}.recording();
  recording.fidelity = "envelope";
  for (std::size_t k = 0; k < 30; ++k) recording.status[k] = kLoopNotLocked;
  Scene scene;
  scene.add(kRateStep, recording);
  EXPECT_NEAR(evaluated("turn_on_time_s", scene.evidence).value, 0.30, 1e-12);
}

/// The table of rates at one temperature.
SceneRun table_run(double temperature, const SignalOfTime& rate_to_answer) {
  return {kRateTable,
          {.duration = 440,
           .step = 0.5,
           .true_rate = table_rate,
           .bias =
               [=](double t) {
                 return rate_to_answer(table_rate(t)) - table_rate(t);
               },
           .temperature = [=](double) { return temperature; }}};
}

TEST(MetricValues, ScaleFactorOfATable) {
  Scene scene;
  for (const double T : {-30.0, 0.0, 25.0, 40.0})
    scene.add(table_run(T, [T](double rate) {
      return 0.5 + (1.002 + 1e-4 * (T - 25)) * rate;
    }));
  expect_exact("scale_factor", scene, 1.002 - 1e-4 * 65.0 / 4, 1e-12);
  expect_exact("scale_factor_error_ppm", scene, 3500, 1e-6);
  expect_exact("scale_factor_nonlinearity_ppm", scene, 0, 1e-6);
  expect_exact("scale_factor_asymmetry_ppm", scene, 0, 1e-6);
  expect_exact("scale_factor_temperature_sensitivity_ppm_per_K", scene,
               100 / 1.002, 1e-6);
}

TEST(MetricValues, NonlinearityAndAsymmetry) {
  Scene scene;
  // The line through x^2 over -1, -0.8 ... 1 is its mean 0.4: the ends are 0.6
  // of c = 0.01 x 100 deg/s above it. K+- = 1 +- c (slope of x^2 over 0 ... 1).
  scene.add(table_run(25, [](double r) { return r + 0.01 * r * r / 100; }));
  expect_exact("scale_factor_nonlinearity_ppm", scene, 1e6 * 0.01 * 0.6, 1e-5);
  expect_exact("scale_factor_asymmetry_ppm", scene, 1e6 * 0.02, 1e-4);
}

TEST(MetricValues, ScaleFactorRetainedIsThatOfTheCompensator) {
  Scene scene;
  EvidenceRun& run =
      scene.add(table_run(25, [](double rate) { return 0.3 + 1.01 * rate; }),
                {.angle_random_walk = 0.01}, 5);
  for (double& rate : run.rate) rate *= 0.98;
  const Estimate found = evaluated("scale_factor_retained", scene.evidence);
  EXPECT_NEAR(found.value, 0.98, 1e-12);
}

TEST(MetricValues, NoiseThatWasHalvedShows) {
  Scene scene;
  EvidenceRun& run = scene.add({kRest, {.duration = 2000, .step = 0.25}},
                               {.angle_random_walk = 0.02}, 3);
  for (double& rate : run.rate) rate *= 0.5;
  expect_exact("white_noise_ratio", scene, 0.5, 1e-12);
}

// Of one stretch alone the ratio is 0.5, of the other 1: that of their sums.
TEST(MetricValues, TheNoiseOfEveryStretchCounts) {
  Scene scene;
  EvidenceRun& run = scene.add({kRest, {.duration = 2000, .step = 0.25}},
                               {.angle_random_walk = 0.02}, 3);
  const std::size_t gap = run.rate.size() / 2;
  for (std::size_t k = 0; k < gap; ++k) run.rate[k] *= 0.5;
  run.rate[gap] = std::nan("");
  const Estimate found = evaluated("white_noise_ratio", scene.evidence);
  EXPECT_NEAR(found.value, std::sqrt(0.625), 0.02);
  EXPECT_LT(found.interval->low, found.value);
}

TEST(MetricValues, WithoutNoiseThereIsNoRatio) {
  const Scene scene({kRest, {.duration = 2000, .step = 0.25}});
  EXPECT_FALSE(find_metric("white_noise_ratio")->evaluate(scene.evidence));
}

TEST(MetricValues, ShareOfSamplesExtrapolated) {
  Scene scene;
  scene.add({kRest, {}}).clamped = 300;
  scene.add({kRest, {}});  // unknown
  expect_exact("extrapolated_share_percent", scene, 25, 1e-12);
}

/// A filter of two poles at `corner` [Hz] answers a sine rate.
void add_sine(Scene& scene, double frequency, double corner) {
  const double omega = 2 * pi * frequency;
  const double lag = 2 * std::atan(frequency / corner);
  const double gain = 1 / (1 + std::pow(frequency / corner, 2));
  const auto rate = [=](double t) { return 5 * std::sin(omega * t); };
  scene.add({kSineRate,
             {.duration = 1 + 5 / frequency + 0.5,
              .step = 1 / std::max(200.0, 40 * frequency),
              .true_rate = rate,
              .bias = [=](double t) {
                return 5 * gain * std::sin(omega * t - lag) - rate(t);
              }}});
}

TEST(MetricValues, BandwidthOfTwoPoles) {
  Scene scene;
  for (const double f : {1.0, 5.0, 10.0, 12.0, 13.0, 14.0, 18.0, 21.0, 25.0})
    add_sine(scene, f, 20);
  // |H| = 1/(1 + (f/fc)^2) is 1/sqrt(2) of that at 1 Hz, linear in dB between
  // 12 and 13 Hz to 1e-3 of the way.
  const double level = std::sqrt(2) * (1 + 1.0 / 400);
  const double corner = 20 * std::sqrt(level - 1);
  expect_exact("bandwidth_Hz", scene, corner, 0.01);
  // Each pole lags by 45 degrees at its corner.
  expect_exact("phase_lag_90_deg_Hz", scene, 20, 0.02);
}

TEST(MetricValues, BandwidthOfTheOutputFilterFromAStep) {
  Scene scene;
  // Two poles of 60 Hz answer a step with 1 - (1 + x) e^-x, x = omega t, and
  // are 3 dB down at 60 sqrt(sqrt(2) - 1) Hz.
  const auto step = [](double t) { return t < 0.99975 ? 0.0 : 10.0; };
  scene.add({kRateStep,
             {.duration = 2,
              .step = 0.0005,
              .true_rate = step,
              .bias = [step](double t) {
                const double x = std::max(0.0, 2 * pi * 60 * (t - 0.99975));
                return -step(t) * (1 + x) * std::exp(-x);
              }}});
  expect_exact("bandwidth_Hz", scene, 60 * std::sqrt(std::sqrt(2.0) - 1), 0.05);
}

TEST(MetricValues, BandwidthOfTheSimulatedOutputFilter) {
  // The quasi-static model has the output filter alone: 38.6 Hz.
  Scene scene;
  for (const int f : {2, 10, 20, 30, 36, 38, 40, 50, 58, 62}) {
    const ScenarioPlan scenario = scenario_from(
        fmt::format("[rate]\nsine = {{ amplitude_deg_per_s = 20, frequency_Hz "
                    "= {} }}\n[noise]\nenabled = false\n",
                    f),
        "[ambient]\nconstant_degC = 25\n", "4", "200");
    scene.add(kSineRate, simulated(scenario, nominal_device()));
  }
  const Estimate found = evaluated("bandwidth_Hz", scene.evidence);
  // |H| at 2 Hz, the reference, is already 1/(1 + (2/60)^2); the converter of
  // 4.6e-3 deg/s is 2e-4 of the amplitude.
  const double level = std::sqrt(2) * (1 + std::pow(2.0 / 60, 2));
  EXPECT_NEAR(found.value, 60 * std::sqrt(level - 1), 0.05);
  EXPECT_NEAR(evaluated("phase_lag_90_deg_Hz", scene.evidence).value, 60, 0.1);
}

/// The response of second order of a resonance at 20 Hz.
std::complex<double> resonance(double f, double damping) {
  const std::complex<double> s(0.0, f / 20);
  return 1.0 / (1.0 + 2.0 * damping * s + s * s);
}

void add_resonant_sine(Scene& scene, double f, double damping) {
  const std::complex<double> gain = resonance(f, damping);
  const auto sine = [f](double t) { return 5 * std::sin(2 * pi * f * t); };
  scene.add(
      {kSineRate,
       {.duration = 4, .step = 0.001, .true_rate = sine, .bias = [=](double t) {
          return 5 * std::abs(gain) *
                     std::sin(2 * pi * f * t + std::arg(gain)) -
                 sine(t);
        }}});
}

TEST(MetricValues, PeakOfAResonance) {
  const double damping = 0.2;
  const double f = 20 * std::sqrt(1 - 2 * damping * damping);
  Scene scene;
  for (const double at : {1.0, 5.0, 12.0, f, 24.0, 40.0})
    add_resonant_sine(scene, at, damping);
  // 1/(2 zeta sqrt(1 - zeta^2)) of the gain at rest. What a step of 1 ms leaves
  // beside whole periods is below 1e-3.
  const double peak = 1 / (2 * damping * std::sqrt(1 - damping * damping));
  const double lowest = std::abs(resonance(1, damping));
  expect_exact("response_peak_dB", scene, 20 * std::log10(peak / lowest), 1e-2);
  expect_exact("response_peak_Hz", scene, f, 1e-3);
}

TEST(MetricValues, AResponseThatOnlyFallsHasNoPeak) {
  Scene scene;
  for (const double at : {1.0, 5.0, 12.0, 24.0})
    add_resonant_sine(scene, at, 1);
  expect_exact("response_peak_dB", scene, 0, 1e-12);
  EXPECT_FALSE(find_metric("response_peak_Hz")->evaluate(scene.evidence));
}

TEST(MetricValues, WithoutAnAnswerThereIsNoResponse) {
  for (const double answer : {0.0, std::nan("")}) {
    Scene scene;
    for (const double at : {1.0, 12.0}) add_resonant_sine(scene, at, 1);
    for (EvidenceRun& run : scene.evidence.runs)
      std::ranges::fill(run.rate, answer);
    for (const char* name :
         {"response_peak_dB", "response_peak_Hz", "bandwidth_Hz"})
      EXPECT_FALSE(find_metric(name)->evaluate(scene.evidence)) << name;
  }
}

TEST(MetricValues, DelayBeyondAPeriodIsUnwrapped) {
  for (const double delay : {0.0, 0.004, 0.1}) {
    Scene scene;
    for (const double f : {0.1, 1.0, 3.0, 9.0, 18.0}) {
      const double omega = 2 * pi * f;
      EvidenceRun& run = scene.add(
          {kSineRate,
           {.duration = 12, .step = 0.005, .true_rate = [=](double t) {
              return 5 * std::sin(omega * t);
            }}});
      for (std::size_t k = 0; k < run.rate.size(); ++k)
        run.rate[k] =
            0.9 * 5 * std::sin(omega * (run.recording->time[k] - delay));
    }
    expect_exact("added_delay_s", scene, delay, 1e-9);
  }
}

TEST(MetricValues, DelayOfARandomRate) {
  const auto rate = [](double t) {
    return 10 * std::sin(0.7 * t) + 8 * std::sin(1.9 * t + 1) +
           6 * std::sin(2.9 * t + 2);
  };
  for (const double delay : {0.0, 0.1, 0.33}) {
    Scene scene;
    EvidenceRun& run = scene.add(
        {kRandomRate, {.duration = 600, .step = 0.1, .true_rate = rate}});
    for (std::size_t k = 0; k < run.rate.size(); ++k)
      run.rate[k] = rate(run.recording->time[k] - delay);
    const Estimate found = evaluated("added_delay_s", scene.evidence);
    // A parabola through three samples misses the top by (omega dt)^2 of dt.
    EXPECT_NEAR(found.value, delay, 0.1 * 0.02);
  }
}

TEST(MetricValues, GSensitivityOfEachAxis) {
  const Scene scene(tumble_run(1e-5, {0.02, -0.01, 0.005}));
  expect_exact("g_sensitivity_x_deg_per_s_per_g", scene, 0.02, 1e-6);
  expect_exact("g_sensitivity_y_deg_per_s_per_g", scene, -0.01, 1e-6);
  expect_exact("g_sensitivity_z_deg_per_s_per_g", scene, 0.005, 1e-6);
}

TEST(MetricValues, GSensitivityOfTheSimulatedGyro) {
  const ScenarioPlan scenario = scenario_from(
      "[noise]\nenabled = false\n[acceleration]\n"
      "x = { steps = [[0, 0], [6000.5, 1], [6060.5, -1], [6120.5, 0]] }\n"
      "y = { steps = [[0, 0], [6120.5, 1], [6180.5, -1], [6240.5, 0]] }\n"
      "z = { steps = [[0, 0], [6240.5, 1], [6300.5, -1]] }\n",
      "[ambient]\nconstant_degC = 25\n", "6360", "1");
  Scene scene;
  scene.add(kTumble, simulated(scenario, nominal_device()));
  // 0.02, 0.02 and 0.005 deg/s/g; the converter's step of 4.6e-3 deg/s does not
  // average without noise: half of it.
  const std::pair<const char*, double> axes[] = {
      {"x", 0.02}, {"y", 0.02}, {"z", 0.005}};
  for (const auto& [axis, sensitivity] : axes)
    EXPECT_NEAR(evaluated(fmt::format("g_sensitivity_{}_deg_per_s_per_g", axis),
                          scene.evidence)
                    .value,
                sensitivity, 2.3e-3);
}

/// 5 g along y that swings once in 100 s, and turns about the cross axes.
Scene vibration_scene() {
  const auto y = [](double t) { return 5 * std::sin(2 * pi * t / 100); };
  const auto turn_x = [](double t) {
    return t < 900 ? 0.0 : t < 1200 ? 60.0 : t < 1500 ? -60.0 : 0.0;
  };
  const auto turn_y = [](double t) {
    return t < 1500 ? 0.0 : t < 1800 ? 60.0 : -60.0;
  };
  return Scene({kVibration,
                {.duration = 2100,
                 .step = 0.5,
                 .bias =
                     [=](double t) {
                       return 0.3 + 0.02 * y(t) + 0.002 * y(t) * y(t) +
                              0.001 * turn_x(t) - 0.003 * turn_y(t);
                     }},
                {{"true_acceleration_y",
                  [=](double t) { return kStandardGravity * y(t); }},
                 {"true_cross_rate_x", turn_x},
                 {"true_cross_rate_y", turn_y}}});
}

TEST(MetricValues, RectificationAndCrossAxis) {
  const Scene scene = vibration_scene();
  expect_exact("vibration_rectification_deg_per_s_per_g2", scene, 0.002, 1e-5);
  expect_exact("cross_axis_percent", scene, 0.3, 3e-4);
}

// ---------------------------------------------------------------------------

TEST(MetricValues, APerfectRateLeavesNothingWhateverTheDeviceStates) {
  Scene scene;
  const auto T = soak_temperatures({-20, 0, 20}, 900);
  scene.add({kSoak, {.duration = 3300, .step = 5, .temperature = T}},
            kNominalNoise, 1);
  scene.add({kRest, {.duration = 4000}}, kNominalNoise, 2);
  scene.add({kWarmUp, {.duration = 1200}}, kNominalNoise, 3);
  for (EvidenceRun& run : scene.evidence.runs)
    run.rate = column_values(*run.recording, "true_rate");
  for (const char* name :
       {"bias_deg_per_s", "bias_pp_deg_per_s", "residual_mean_deg_per_s",
        "residual_rms_deg_per_s", "residual_max_deg_per_s",
        "residual_pp_deg_per_s", "normalised_residual",
        "in_run_stability_deg_per_s", "power_on_drift_3_min_deg_per_s",
        "heading_error_10_min_deg", "warm_up_time_s"}) {
    SCOPED_TRACE(name);
    const Estimate found = evaluated(name, scene.evidence);
    EXPECT_EQ(found.value, 0.0);
    EXPECT_EQ(found.interval->low, 0.0);
    EXPECT_EQ(found.interval->high, 0.0);
  }
}

TEST(MetricValues, OneMissingAnswerOfAHundredThousandIsNoNumber) {
  Scene scene;
  EvidenceRun& run = scene.add({kRest, {.duration = 50000}}, kNominalNoise, 2);
  ASSERT_EQ(run.rate.size(), 100000u);
  run.rate[31415] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(evaluated("bias_deg_per_s", scene.evidence).value));
  EXPECT_TRUE(
      std::isnan(evaluated("residual_max_deg_per_s", scene.evidence).value));
}

}  // namespace
}  // namespace beamgyro::internal::metric_values_test
