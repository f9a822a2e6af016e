// SPDX-License-Identifier: MIT
#include "sim/dynamics/mechanical_noise.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "random/random_stream.h"
#include "sim/dynamics/complex_form.h"
#include "sim/dynamics/loop_noise.h"
#include "sim/signal/linear_noise.h"
#include "tests/config/rejection.h"
#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"
#include "tests/sim/signal/allan_deviation.h"

namespace beamgyro::internal::mechanical_noise_test {
namespace {

using Eigen::Index;
using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector2cd;

constexpr double kT0 = kCalibrationTemperature;

// The nominal unit at rest at one temperature.
struct Modes {
  TrimmedGyro gyro;
  ModalParameters modal;
  StaticSolution solution;
  NoiseDensities density;
  Matrix2d velocity;  // C/m
  Matrix4d A;         // of the envelope

  explicit Modes(double T = kT0, const std::vector<std::string>& overrides = {})
      : gyro(make_gyro(verification_device(overrides))),
        modal(modal_at(gyro, T)),
        solution(static_solution(modal, gyro.loop,
                                 gyro.device.readout.feedthrough, {})),
        density(
            noise_densities(gyro.device, modal, T, solution.drive_frequency)),
        velocity(modal.damping / modal.mass),
        A(real_form(EnvelopePlant(modal.stiffness / modal.mass, velocity,
                                  solution.drive_frequency)
                        .from_amplitude())) {}

  BrownianInput brownian() const {
    return brownian_input(density.force, modal.mass, velocity, A,
                          solution.drive_frequency);
  }
  Matrix2d compliance() const { return reference::inverse(modal.stiffness); }
  NoiseSystem envelope() const { return {A, brownian().input}; }
};

TEST(NoiseDensities, AreThoseOfTheNominalUnit) {
  const Modes modes;
  EXPECT_NEAR(std::sqrt(modes.density.force(0, 0)), 2.97e-11, 0.01e-11);
  EXPECT_NEAR(modes.density.force(0, 1) / modes.density.force(0, 0),
              modes.modal.damping(0, 1) / modes.modal.damping(0, 0), 1e-15);
  const double C_p = patch_capacitance(modes.gyro.device.patches, kT0);
  EXPECT_NEAR(C_p, 1.27e-9, 0.005e-9);
  EXPECT_NEAR(std::sqrt(modes.density.amplifier),
              5e-9 * (C_p + 100e-12 + 50e-12), 1e-25);
  EXPECT_NEAR(
      modes.density.dielectric,
      4 * 1.380649e-23 * 298.15 * 0.02 * C_p / (2 * std::numbers::pi * 9081.5),
      1e-5 * modes.density.dielectric);
}

TEST(BrownianInput, OfOneModeIsTheNoiseOfItsEnvelopeEquation) {
  const double m = 7e-4, w = 5.7e4, tau = 0.027;
  const Matrix2d velocity = 2 / tau * Matrix2d::Identity();
  const Matrix4d A = -1 / tau * Matrix4d::Identity();
  const double force = 4 * kBoltzmann * kT0 * 2 * m / tau;
  const BrownianInput b =
      brownian_input(force * Matrix2d::Identity(), m, velocity, A, w);
  const double s2 = 2 * kBoltzmann * kT0 / (m * w * w * tau);
  EXPECT_LT((b.input * b.input.transpose() / s2 - Matrix4d::Identity()).norm(),
            1e-6);
}

TEST(BrownianInput, HasTheStaticResponseAtLowFrequencies) {
  const Modes modes;
  const BrownianInput b = modes.brownian();
  const Matrix4d low =
      b.direct - Matrix4d(reference::solution(modes.A, b.input));
  const Matrix2cd S =
      dynamic_stiffness(modes.modal, modes.solution.drive_frequency, {});
  const Matrix4d compliance = real_form(reference::inverse(S));
  // Both through their product, free of the root taken of the density.
  const Matrix4d covariance = low * low.transpose();
  const Matrix4d expected = compliance *
                            real_form(modes.density.force.cast<Complex>()) *
                            compliance.transpose();
  EXPECT_LT((covariance - expected).norm(), 2e-4 * expected.norm());
  EXPECT_NEAR(covariance(2, 2) / expected(2, 2), 1, 5e-4);
}

TEST(Verification, V33CarrierWithThermalForceHasTheEnergyOfBothModes) {
  const Modes modes;
  const double m = modes.modal.mass;
  MatrixXd A = MatrixXd::Zero(4, 4), B = MatrixXd::Zero(4, 2);
  A.topRightCorner(2, 2).setIdentity();
  A.bottomLeftCorner(2, 2) = -modes.modal.stiffness / m;
  A.bottomRightCorner(2, 2) = -modes.velocity;
  // Intensity is half the one-sided density.
  B.bottomRows(2) = reference::cholesky_root(modes.density.force / 2);
  B /= m;
  const MatrixXd root = stationary_root({A, B});
  const MatrixXd Sigma = root * root.transpose();
  const double kT = kBoltzmann * kT0;
  const Matrix2d position = kT * modes.compliance();
  EXPECT_LT((Sigma.topLeftCorner(2, 2) - position).norm(),
            1e-8 * position.norm());
  EXPECT_LT(
      (Sigma.bottomRightCorner(2, 2) * m / kT - Matrix2d::Identity()).norm(),
      1e-8);
  EXPECT_NEAR(std::sqrt(Sigma(0, 0)), 4.2e-14, 0.05e-14);
}

TEST(Verification, V33EnvelopeCovarianceIsTwiceTheTemperatureOverTheStiffness) {
  for (const double T : {235.0, kT0, 330.0}) {
    const Modes modes(T);
    const MatrixXd root = stationary_root(modes.envelope());
    const Matrix4d expected =
        real_form((kBoltzmann * T * modes.compliance()).cast<Complex>());
    EXPECT_LT((root * root.transpose() - expected).norm(),
              5e-4 * expected.norm())
        << T;
  }
}

// Mean of |X|^2 k/(2 k_B T) and |Y|^2 k/(2 k_B T) over one realisation, and 3
// sigma of it. |Y|^2 is exponentially distributed, its correlation falls with
// e^{-2 t/tau}.
struct Energy {
  double x, y, three_sigma;
};

Energy mean_energy(const Modes& modes, double h, int samples,
                   std::uint32_t run) {
  LinearNoise noise(modes.envelope(), h, {5, 0, run, kMechanicalNoiseStream});
  Energy sum{};
  for (int k = 0; k < samples; ++k, noise.advance()) {
    sum.x += noise.state().head<2>().squaredNorm();
    sum.y += noise.state().tail<2>().squaredNorm();
  }
  const double kT = kBoltzmann * kT0;
  const Matrix2d& K = modes.modal.stiffness;
  const double decay = std::min(modes.velocity(0, 0), modes.velocity(1, 1)) / 2;
  const double independent = samples * std::tanh(decay * h);
  return {sum.x * K(0, 0) / (2 * kT * samples),
          sum.y * K(1, 1) / (2 * kT * samples), 3 / std::sqrt(independent)};
}

TEST(Verification, V33SampledEnvelopeHasTheEnergyOfBothModes) {
  const Energy energy = mean_energy(Modes(), 1e-3, 400000, 0);
  EXPECT_LT(energy.three_sigma, 0.03);
  EXPECT_NEAR(energy.x, 1, energy.three_sigma);
  EXPECT_NEAR(energy.y, 1, energy.three_sigma);
}

TEST(Verification, V34VarianceDoesNotDependOnTheStep) {
  const Modes modes;
  const MatrixXd root = stationary_root(modes.envelope());
  const MatrixXd Sigma = root * root.transpose();
  std::uint32_t run = 1;
  for (const double h : {1e-4, 1e-3, 1e-1}) {
    const SampledNoise sampled = sampled_noise(modes.envelope(), h);
    const MatrixXd kept =
        sampled.transition * Sigma * sampled.transition.transpose() +
        sampled.root * sampled.root.transpose();
    EXPECT_LT((kept - Sigma).norm(), 1e-11 * Sigma.norm()) << h;
    const Energy energy = mean_energy(modes, h, 1000000, run++);
    EXPECT_LT(energy.three_sigma, 0.05);
    EXPECT_NEAR(energy.x, 1, energy.three_sigma) << h;
    EXPECT_NEAR(energy.y, 1, energy.three_sigma) << h;
  }
}

TEST(LowFrequencyNoise, IsThatOfTheNominalUnit) {
  const Modes modes;
  const RateNoiseDensity noise = low_frequency_noise(modes.gyro, kT0, kT0);
  EXPECT_NEAR(noise.brownian / kDegree, 2.9e-5, 0.05e-5);
  EXPECT_NEAR(noise.dielectric / kDegree, 2.8e-5, 0.05e-5);
  EXPECT_NEAR(noise.amplifier / kDegree, 7.3e-5, 0.05e-5);
  EXPECT_NEAR(noise.total() / kDegree, std::hypot(2.9, 2.8, 7.3) * 1e-5,
              0.05e-5);

  const double w = modes.solution.drive_frequency;
  const double A = std::abs(modes.solution.amplitude(0));
  EXPECT_NEAR(noise.brownian * std::sqrt(2) * modes.modal.mass * w * A /
                  std::sqrt(modes.density.force(1, 1)),
              1, 0.01);
  EXPECT_NEAR(noise.amplifier * std::abs(modes.gyro.rate_axis) /
                  std::sqrt(2 * modes.density.amplifier),
              1, 1e-4);
}

TEST(LowFrequencyNoise, WeighsNoiseWithTheScaleFactorOfTheUnit) {
  // Half the amplitude: half the signal, the same noise.
  const Modes modes, weak(kT0, {"drive.amplitude_m=0.5e-6"});
  const RateNoiseDensity a = low_frequency_noise(modes.gyro, kT0, kT0);
  const RateNoiseDensity b = low_frequency_noise(weak.gyro, kT0, kT0);
  EXPECT_NEAR(b.brownian / a.brownian, 2, 1e-5);
  EXPECT_NEAR(b.dielectric / a.dielectric, 2, 1e-5);
  EXPECT_NEAR(b.amplifier / a.amplifier, 2, 1e-5);
}

TEST(LowFrequencyNoise, WeighsNoiseWithTheSignalOfADriveAtItsLimit) {
  const Modes modes, held(kT0, {"drive.voltage_limit_V=0.4"});
  ASSERT_FALSE(held.solution.amplitude_locked);
  const double ratio =
      modes.solution.drive_voltage / held.solution.drive_voltage;
  const RateNoiseDensity a = low_frequency_noise(modes.gyro, kT0, kT0);
  const RateNoiseDensity b = low_frequency_noise(held.gyro, kT0, kT0);
  EXPECT_NEAR(b.brownian / a.brownian, ratio, 1e-3 * ratio);
  EXPECT_NEAR(b.dielectric / a.dielectric, ratio, 1e-4 * ratio);
  EXPECT_NEAR(b.amplifier / a.amplifier, ratio, 1e-4 * ratio);
}

// One-sided density of the output at frequency 0 of the sources in columns
// `first` .. of the noise of the loops.
double low_frequency(const NoiseSystem& system, Index first, Index count) {
  const MatrixXd gain =
      reference::solution(system.A, system.B.middleCols(first, count));
  return std::sqrt(2) * gain.row(kOutput2).norm();
}

NoiseSystem looped(const Modes& modes, double T) {
  EnvelopeOde ode(modes.gyro, drive_heating(modes.gyro));
  return loop_noise(modes.gyro, ode, T, T);
}

class LoopedNoise : public testing::TestWithParam<std::string> {};

TEST_P(LoopedNoise, OfTheEnvelopeIsTheStaticOneAtLowFrequencies) {
  for (const double T : {240.0, kT0, 320.0}) {
    const Modes modes(T, {GetParam()});
    const NoiseSystem system = looped(modes, T);
    const RateNoiseDensity noise = low_frequency_noise(modes.gyro, T, T);
    EXPECT_NEAR(low_frequency(system, 0, 4) / noise.brownian, 1, 1e-4) << T;
    EXPECT_NEAR(low_frequency(system, 4, 4) /
                    std::hypot(noise.dielectric, noise.amplifier),
                1, 1e-9)
        << T;
  }
}

TEST_P(LoopedNoise, SampledHasTheAllanDeviationOfTheStaticOne) {
  constexpr double kInterval = 4e-3;
  constexpr std::size_t kSamples = 500000;
  const Modes modes(kT0, {GetParam()});
  LinearNoise noise(looped(modes, kT0), kInterval,
                    {3, 0, 0, kMechanicalNoiseStream});
  std::vector<double> rate(kSamples);
  for (double& r : rate) {
    noise.advance();
    r = noise.state()(kOutput2);
  }
  const double N =
      low_frequency_noise(modes.gyro, kT0, kT0).total() / std::sqrt(2);
  for (const std::size_t m : {250u, 2500u}) {
    const AllanDeviation adev = allan_deviation(rate, m);
    const double tau = static_cast<double>(m) * kInterval;
    EXPECT_NEAR(adev.value * std::sqrt(tau) / N, 1,
                adev.three_sigma * std::sqrt(tau) / N)
        << tau;
  }
}

// A large quadrature lets the noise of the drive loops into the output.
INSTANTIATE_TEST_SUITE_P(
    Modes, LoopedNoise,
    testing::Values("readout.mode=\"open_loop\"",
                    "readout.mode=\"force_rebalance\"",
                    "readout.quadrature_trim_deg_per_s=4000"));

TEST(MechanicalNoise, RejectsBadInput) {
  const Modes modes;
  const double w = modes.solution.drive_frequency;
  const auto densities = [&](double T, double frequency) {
    return rejection(
        [&] { noise_densities(modes.gyro.device, modes.modal, T, frequency); });
  };
  EXPECT_EQ(densities(-3, w),
            "noise: beam temperature is -3 K, must be above 0");
  EXPECT_EQ(densities(NAN, w),
            "noise: beam temperature is nan K, must be above 0");
  EXPECT_EQ(densities(kT0, 0),
            "noise: drive frequency is 0 rad/s, must be above 0");
  EXPECT_EQ(rejection([&] { low_frequency_noise(modes.gyro, 0, kT0); }),
            "noise: beam temperature is 0 K, must be above 0");
  Matrix4d bent = modes.A;
  bent(0, 0) += 5;
  EXPECT_EQ(rejection([&] {
              brownian_input(modes.density.force, modes.modal.mass,
                             modes.velocity, bent, w);
            }),
            "envelope matrix is not the real form of a complex 2 x 2 matrix: "
            "off by 2.5 1/s, must be blocks [[a, -b], [b, a]]");
  EXPECT_EQ(rejection([&] {
              brownian_input(Matrix2d{{1, 2}, {2, 1}}, modes.modal.mass,
                             modes.velocity, modes.A, w);
            }),
            "force noise density [[1, 2], [2, 1]] N2/Hz has a negative "
            "eigenvalue, must be positive semidefinite");
  EXPECT_EQ(rejection([&] {
              brownian_input(modes.density.force, 0, modes.velocity, modes.A,
                             w);
            }),
            "noise: modal mass is 0 kg, must be above 0");
}

}  // namespace
}  // namespace beamgyro::internal::mechanical_noise_test
