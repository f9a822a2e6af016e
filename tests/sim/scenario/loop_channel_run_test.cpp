// SPDX-License-Identifier: MIT
// Channels of the loops in recordings (physics: docs/model.md, section 5).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "sim/dynamics/envelope.h"
#include "sim/dynamics/mechanical_noise.h"
#include "sim/scenario/simulation.h"
#include "sim/signal/readout.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::loop_channel_run_test {
namespace {

// A unit that makes no heat, with channels that are not quantised.
DeviceParameters unit(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(),
                   {"thermal.electronics_power_W=0.0",
                    "readout.drive_frequency_resolution_Hz=0.0",
                    "readout.drive_voltage_resolution_V=0.0",
                    "readout.quadrature_resolution_deg_per_s=0.0"});
  return nominal_device(overrides);
}

const std::vector<std::string> kNoise = {"loop_channels.noise=true"};
const std::string kAt25 = "[ambient]\nconstant_degC = 25\n";

Recording at_rest(Fidelity fidelity, const DeviceParameters& device,
                  const std::string& duration, double rate) {
  ScenarioPlan scenario = scenario_from("", kAt25, duration);
  scenario.fidelity = fidelity;
  scenario.output_rate = rate;
  return simulated(scenario, device);
}

// Noise of the channel, without its first `lost` seconds.
std::vector<double> frequency_noise(const Recording& recording, double lost) {
  const auto& shown = column_values(recording, "drive_frequency");
  const auto& is = column_values(recording, "true_drive_frequency");
  std::vector<double> noise;
  for (std::size_t k = 0; k < shown.size(); ++k)
    if (recording.time[k] >= lost) noise.push_back(shown[k] - is[k]);
  return noise;
}

// One-sided density of the loop's frequency [Hz2/Hz] in closed form: of one
// mode, its phase loop and the two poles of the demodulator. A phase error phi
// in front of the demodulator and a shift n of the resonance make
//   theta' = C F (phi - (theta' - n) tau / (1 + s tau)),  C = K_p + K_i / s.
class PhaseLoop {
 public:
  explicit PhaseLoop(const DeviceParameters& device)
      : gyro_(make_gyro(device)) {
    EnvelopeOde ode(gyro_, drive_heating(gyro_));
    loops_ = ode.loops();
    const ModalParameters modal = modal_at(gyro_, kCalibrationTemperature);
    const double w = loops_.nominal_frequency;
    const NoiseDensities density =
        noise_densities(gyro_.device, modal, kCalibrationTemperature, w);
    tau_ = decay_time(modal);
    phase_ = 2 * (density.dielectric + density.amplifier) /
             (loops_.feedback_scale * loops_.feedback_scale);
    const double momentum =
        2 * modal.mass * w * gyro_.device.drive.amplitude;  // [kg m/s]
    shift_ = 2 * density.force(0, 0) / (momentum * momentum);
  }

  double density(double f) const {
    const std::complex<double> s(0, 2 * std::numbers::pi * f);
    const double wf = loops_.demodulator_corner;
    const std::complex<double> pole = wf / (s + wf);
    const std::complex<double> open =
        (loops_.pll_proportional + loops_.pll_integral / s) * pole * pole;
    const std::complex<double> beam = tau_ / (1.0 + s * tau_);
    const double gain = std::norm(open / (1.0 + open * beam));
    return gain * (phase_ + std::norm(beam) * shift_) / std::norm(kCycle);
  }

  // (f_d / 2Q)^2 S_phi, with the phase noise of the beam, S_n tau^2.
  double leeson() const {
    const double half_width = 1 / (kCycle * tau_);  // f_d / 2Q [Hz]
    return half_width * half_width * (phase_ + shift_ * tau_ * tau_);
  }

 private:
  static constexpr double kCycle = 2 * std::numbers::pi;
  TrimmedGyro gyro_;
  LoopElectronics loops_;
  double tau_, phase_, shift_;  // [s] [rad2/Hz] [(rad/s)2/Hz]
};

// Fourier sums of `samples`, every `stride` of them from `first`; their number
// is a power of two.
std::vector<std::complex<double>> spectrum(const std::vector<double>& samples,
                                           std::size_t first = 0,
                                           std::size_t stride = 1) {
  const std::size_t count = samples.size() / stride;
  if (count == 1) return {samples[first]};
  std::vector<std::complex<double>> sums = spectrum(samples, first, 2 * stride);
  const auto odd = spectrum(samples, first + stride, 2 * stride);
  sums.resize(count);
  for (std::size_t k = 0; k < count / 2; ++k) {
    const auto turned =
        odd[k] *
        std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) /
                            static_cast<double>(count));
    sums[k + count / 2] = sums[k] - turned;
    sums[k] += turned;
  }
  return sums;
}

// Mean of the periodogram, of the Fourier sums of a noise, over S from `low` to
// `high` [Hz], and its sigma.
struct Ratio {
  double mean, sigma;
};
Ratio ratio_to(const PhaseLoop& loop,
               const std::vector<std::complex<double>>& sums, double rate,
               double low, double high) {
  const double step = rate / static_cast<double>(sums.size());
  double sum = 0;
  int bins = 0;
  for (std::size_t i = 1; i < sums.size() / 2; ++i) {
    const double f = step * static_cast<double>(i);
    if (f < low || f > high) continue;
    sum += 2 * std::norm(sums[i]) * step / (rate * rate) / loop.density(f);
    ++bins;
  }
  return {sum / bins, 1 / std::sqrt(bins)};
}

TEST(Verification, V55DriveFrequencyHasTheNoiseOfThePhaseLoop) {
  constexpr double kRate = 2000;  // [Hz], beyond the bandwidth of the loop
  const DeviceParameters device = unit(kNoise);
  const PhaseLoop loop(device);
  EXPECT_NEAR(loop.density(0.1) / loop.leeson(), 1, 0.01);
  std::vector<double> noise =
      frequency_noise(at_rest(Fidelity::kEnvelope, device, "525", kRate), 0);
  noise.resize(std::size_t{1} << 20);  // 524 s
  const std::vector<std::complex<double>> sums = spectrum(noise);
  const Ratio all = ratio_to(loop, sums, kRate, 0.1, 10);
  EXPECT_LT(3 * all.sigma, 0.05);
  EXPECT_NEAR(all.mean, 1, 0.05);
  for (const auto& [low, high] :
       {std::pair{0.1, 2.0}, {2.0, 5.0}, {5.0, 10.0}}) {
    const Ratio part = ratio_to(loop, sums, kRate, low, high);
    EXPECT_NEAR(part.mean, 1, 3 * part.sigma + 0.01) << low;
  }
}

TEST(LoopChannelRun, QuasistaticNoiseHasTheDensityBelowTheBandwidth) {
  constexpr double kRate = 10;
  const DeviceParameters device = unit(kNoise);
  const std::vector<double> noise = frequency_noise(
      at_rest(Fidelity::kQuasistatic, device, "5000", kRate), 0);
  double variance = 0;
  for (const double n : noise)
    variance += n * n / static_cast<double>(noise.size());
  // 1 %: the closed form leaves the sense mode out.
  EXPECT_NEAR(variance / (PhaseLoop(device).leeson() / 2 * kRate), 1,
              3 * std::sqrt(2.0 / static_cast<double>(noise.size())) + 0.01);
}

TEST(LoopChannelRun, CarrierAndEnvelopeHaveTheSameNoise) {
  const DeviceParameters device = unit(kNoise);
  const auto envelope =
      frequency_noise(at_rest(Fidelity::kEnvelope, device, "1.5", 100), 0);
  const auto carrier =
      frequency_noise(at_rest(Fidelity::kCarrier, device, "1.5", 100), 0);
  ASSERT_EQ(envelope.size(), carrier.size());
  const double largest = *std::ranges::max_element(envelope);
  EXPECT_GT(largest, 0);
  // Coefficients agree to the self-heating of the beam, 6 mK.
  for (std::size_t k = 0; k < carrier.size(); ++k)
    EXPECT_NEAR(carrier[k], envelope[k], 1e-3 * largest) << k;
}

TEST(LoopChannelRun, NoiseOfTheChannelsLeavesTheRateAsItIs) {
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope}) {
    const Recording off = at_rest(fidelity, unit({}), "20", 10);
    const Recording on = at_rest(fidelity, unit(kNoise), "20", 10);
    EXPECT_EQ(find_column(off, "true_drive_frequency"), nullptr);
    for (const char* name : {"output", "temperature", "true_bias"})
      EXPECT_EQ(column_values(on, name), column_values(off, name)) << name;
    EXPECT_EQ(column_values(on, "true_drive_frequency"),
              column_values(off, "drive_frequency"));
    for (const char* name : {"drive_frequency", "drive_voltage", "quadrature"})
      EXPECT_NE(column_values(on, name), column_values(off, name)) << name;
  }
}

TEST(LoopChannelRun, WithoutNoiseClockAndGainStay) {
  ScenarioPlan scenario = scenario_from("[age]\nhours = 4383\n",
                                        "[ambient]\nconstant_degC = -20\n");
  scenario.noise_enabled = false;
  const DeviceParameters device =
      unit({"loop_channels.noise=true", "loop_channels.clock_offset_ppm=10.0",
            "loop_channels.clock_tc2_ppm_per_K2=-0.034",
            "loop_channels.clock_ageing_ppm_per_year=2.0",
            "loop_channels.drive_voltage_gain_error=0.01",
            "loop_channels.drive_voltage_gain_tc_per_K=1e-4",
            "loop_channels.quadrature_offset_deg_per_s=0.5",
            "loop_channels.quadrature_offset_tc_deg_per_s_per_K=0.02"});
  const Recording off = simulated(scenario, unit({}));
  const Recording on = simulated(scenario, device);
  const auto change = [&](const char* name, std::size_t k) {
    return column_values(on, name)[k] - column_values(off, name)[k];
  };
  for (const std::size_t k : {std::size_t{0}, std::size_t{999}}) {
    // Half a year; the run itself is too short to count. -45 K to T_0.
    const double y = 1e-6 * (10 - 0.034 * 45 * 45 + 1);
    const double f = column_values(off, "drive_frequency")[k];
    const double V = column_values(off, "drive_voltage")[k];
    EXPECT_NEAR(change("drive_frequency", k) / f, y, 1e-10);
    EXPECT_NEAR(change("drive_voltage", k) / V, 0.01 - 0.0045, 1e-7);
    EXPECT_NEAR(change("quadrature", k), 0.5 - 0.9, 1e-5);
    EXPECT_EQ(column_values(on, "true_drive_frequency")[k], f);
  }
}

TEST(LoopChannelRun, SaysWhereNoiseHidesBehindTheResolution) {
  const ScenarioPlan scenario = scenario_from("");
  const Recording on = simulated(scenario, nominal_device(kNoise));
  const std::string comment = find_column(on, "drive_frequency")->comment;
  EXPECT_TRUE(holds(comment, "is below the resolution of 0.001 Hz"));
  EXPECT_NE(find_column(on, "drive_voltage")->comment, "");
  // 0.01 deg/s x sqrt(10 Hz) is above 0.01 deg/s.
  EXPECT_EQ(find_column(on, "quadrature")->comment, "");
  const Recording off = simulated(scenario, nominal_device());
  for (const Column& column : off.columns) EXPECT_EQ(column.comment, "");
}

TEST(LoopChannelRun, NoiseOfADriveAtItsLimitIsFinite) {
  const DeviceParameters device =
      unit({"loop_channels.noise=true", "drive.voltage_limit_V=0.7"});
  ScenarioPlan scenario =
      scenario_from("", "[ambient]\nconstant_degC = 50\n", "10");
  const Recording recording = simulated(scenario, device);
  ASSERT_TRUE(recording.status[0] & kLoopNotLocked);
  const double limit = column_values(recording, "drive_voltage")[0];
  for (const double V : column_values(recording, "drive_voltage"))
    EXPECT_EQ(V, limit);
  for (const double n : frequency_noise(recording, 0))
    EXPECT_LT(std::abs(n), 1e-4);
}

TEST(LoopChannelRun, TheTransientOfATurnOnSettles) {
  ScenarioPlan scenario = scenario_from(
      "[power]\non_s = [0, 2000]\noff_s = [1000]\n", kAt25, "3000", "1");
  const std::vector<std::string> quiet = {
      "noise.angle_random_walk_deg_per_sqrt_s=0.0",
      "noise.bias_instability_deg_per_s=0.0",
      "noise.rate_random_walk_deg_per_s_per_sqrt_s=0.0",
      "noise.turn_on_deg_per_s=0.0",
      "readout.adc_bits=32",
      "readout.amplifier_noise_V_per_sqrt_Hz=0.0"};
  std::vector<std::string> on = quiet;
  on.push_back("noise.turn_on_transient_deg_per_s=0.5");
  const auto with = column_values(simulated(scenario, unit(on)), "rate");
  const auto without = column_values(simulated(scenario, unit(quiet)), "rate");
  const std::vector<double> off = {INFINITY, 1000};
  const auto starts = turn_on_transients(
      {.turn_on_transient = 0.5, .turn_on_recovery = 3600}, off, 7, 0, 0);
  for (const int k : {0, 150, 900}) {
    const auto at = static_cast<std::size_t>(k);
    const double left = std::exp(-k / 200.0);
    EXPECT_NEAR(with[at] - without[at], starts[0] * left, 2e-7);
    EXPECT_NEAR(with[2000 + at] - without[2000 + at], starts[1] * left, 2e-7);
  }
}

}  // namespace
}  // namespace beamgyro::internal::loop_channel_run_test
