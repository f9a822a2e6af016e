// SPDX-License-Identifier: MIT
#include "sim/dynamics/mechanical_noise.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "linear_algebra/eigenvalues.h"
#include "linear_algebra/linear_systems.h"
#include "sim/dynamics/complex_form.h"

namespace beamgyro::internal {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2cd;
using Eigen::Vector4d;

void require_positive(double value, const char* what, const char* unit) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument(
        fmt::format("{} is {} {}, must be above 0", what, value, unit));
  }
}

// Symmetric square root of a one-sided force density [N/sqrt(Hz)].
Matrix2d force_root(const Matrix2d& density) {
  constexpr double kRounding = 1e-12;
  const SymmetricEigen eigen = symmetric_eigen(density);
  Eigen::Vector2d value = eigen.values;
  if (!(value(1) >= 0 && value(0) >= -kRounding * value(1))) {
    throw std::invalid_argument(fmt::format(
        "force noise density [[{}, {}], [{}, {}]] N2/Hz has a negative "
        "eigenvalue, must be positive semidefinite",
        density(0, 0), density(0, 1), density(1, 0), density(1, 1)));
  }
  value = value.cwiseMax(0).cwiseSqrt();
  const Matrix2d vectors = eigen.vectors;
  return vectors * value.asDiagonal() * vectors.transpose();
}

Matrix2cd complex_form(const Matrix4d& real) {
  constexpr double kTolerance = 1e-6;
  Matrix2cd matrix;
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (Eigen::Index j = 0; j < 2; ++j) {
      const Matrix2d b = real.block<2, 2>(2 * i, 2 * j);
      matrix(i, j) = 0.5 * Complex(b(0, 0) + b(1, 1), b(1, 0) - b(0, 1));
    }
  }
  const double error = (real_form(matrix) - real).cwiseAbs().maxCoeff();
  if (!(error <= kTolerance * real.cwiseAbs().maxCoeff())) {
    throw std::invalid_argument(fmt::format(
        "envelope matrix is not the real form of a complex 2 x 2 matrix: off "
        "by {} 1/s, must be blocks [[a, -b], [b, a]]",
        error));
  }
  return matrix;
}

// Quantities that the loops hold constant, under a small change.
struct Held {
  Complex feedback;  // -Theta_F^T u, relative: amplitude and phase error
  Complex readout;   // Theta_R^T u + C_ft V_D [C]
};

// Small changes about a static solution. The loops answer with the unknowns
// V_D, w_d and, with force rebalance, Re V_B, Im V_B.
class LoopedResponse {
 public:
  LoopedResponse(const TrimmedGyro& gyro, const ModalParameters& modal,
                 const StaticSolution& s)
      : modal_(modal),
        feedback_(charge_of(modal.coupling[kFeedback], s.amplitude)),
        feedthrough_(gyro.device.readout.feedthrough),
        rebalance_(gyro.loop.mode == ReadoutMode::kForceRebalance),
        amplitude_locked_(s.amplitude_locked),
        compliance_(
            inverse_of(dynamic_stiffness(modal, s.drive_frequency, {}))) {
    const Matrix2cd slope = dynamic_stiffness_slope(modal, s.drive_frequency);
    answer_[0] = held(modal.coupling[kDrive], 1.0);
    answer_[1] = held(-(slope * s.amplitude), 0.0);
    answer_[2] = held(modal.coupling[kDamping], 0.0);
    answer_[3] = held(kI * modal.coupling[kDamping], 0.0);
    for (int j = 0; j < 4; ++j) {
      conditions_.col(j) = errors(answer_[static_cast<std::size_t>(j)], j);
    }
  }

  // Change of the signal of StaticSolution by a force on the modes and by
  // charges on the two patches that are read.
  Complex signal(const Vector2cd& force, Complex feedback_charge,
                 Complex readout_charge) const {
    Held open = held(force, 0.0);
    open.feedback += feedback_charge / feedback_;
    open.readout += readout_charge;
    const Vector4d x = -solve_system(conditions_, errors(open, kDisturbance));
    if (rebalance_) return {x(2), x(3)};
    return open.readout + answer_[0].readout * x(0) + answer_[1].readout * x(1);
  }

 private:
  static constexpr int kDisturbance = -1;

  Held held(const Vector2cd& force, double voltage) const {
    const Vector2cd u = compliance_ * force;
    return {charge_of(modal_.coupling[kFeedback], u) / feedback_,
            charge_of(modal_.coupling[kReadout], u) + feedthrough_ * voltage};
  }

  // The four errors that the loops bring to zero; for a loop that is not there
  // its own unknown.
  Vector4d errors(const Held& h, int unknown) const {
    Vector4d e(h.feedback.real(), h.feedback.imag(), h.readout.real(),
               h.readout.imag());
    if (!amplitude_locked_) e(0) = unknown == 0 ? 1 : 0;
    if (!rebalance_) {
      e(2) = unknown == 2 ? 1 : 0;
      e(3) = unknown == 3 ? 1 : 0;
    }
    return e;
  }

  const ModalParameters& modal_;
  Complex feedback_;  // Theta_F^T u [C]
  double feedthrough_;
  bool rebalance_, amplitude_locked_;
  Matrix2cd compliance_;  // S^-1 [m/N]
  std::array<Held, 4> answer_;
  Matrix4d conditions_;  // errors() of each unknown
};

}  // namespace

NoiseDensities noise_densities(const DeviceParameters& device,
                               const ModalParameters& modal, double T,
                               double drive_frequency) {
  require_positive(T, "noise: beam temperature", "K");
  require_positive(drive_frequency, "noise: drive frequency", "rad/s");
  const ReadoutParameters& readout = device.readout;
  const double C_p = patch_capacitance(device.patches, T);
  const double amplifier =
      readout.amplifier_noise *
      (C_p + readout.feedback_capacitance + readout.input_capacitance);
  return {
      4 * kBoltzmann * T * damping_at(modal, drive_frequency),
      4 * kBoltzmann * T * device.patches.loss_tangent * C_p / drive_frequency,
      amplifier * amplifier};
}

BrownianInput brownian_input(const Matrix2d& force_density, double mass,
                             const Matrix2d& velocity, const Matrix4d& A,
                             double drive_frequency) {
  require_positive(mass, "noise: modal mass", "kg");
  require_positive(drive_frequency, "noise: drive frequency", "rad/s");
  const Matrix2cd slow = complex_form(A);
  const Matrix2cd P =
      velocity + 2.0 * kI * drive_frequency * Matrix2cd::Identity();
  const Matrix2cd input = inverse_of(Matrix2cd(P + 2.0 * slow)) *
                          (force_root(force_density) / mass);
  const Matrix2cd direct = -inverse_of(Matrix2cd(P + slow)) * input;
  return {real_form(input), real_form(direct)};
}

double RateNoiseDensity::total() const {
  return std::sqrt(brownian * brownian + dielectric * dielectric +
                   amplifier * amplifier);
}

RateNoiseDensity low_frequency_noise(const TrimmedGyro& gyro,
                                     double beam_temperature,
                                     double board_temperature) {
  require_positive(beam_temperature, "noise: beam temperature", "K");
  const ModalParameters modal = modal_at(gyro, beam_temperature);
  const StaticSolution solution = static_solution(gyro, modal, {});
  const NoiseDensities density = noise_densities(
      gyro.device, modal, beam_temperature, solution.drive_frequency);
  const LoopedResponse response(gyro, modal, solution);
  const Complex to_rate =
      electronics_at(gyro, board_temperature).turn / gyro.rate_axis;

  // Square of the rate per unit of each real and imaginary part, whose
  // one-sided density is twice that of the noise.
  const auto power = [&](const Vector2cd& force, Complex feedback,
                         Complex readout) {
    const double real =
        (to_rate * response.signal(force, feedback, readout)).real();
    const double imaginary =
        (to_rate * response.signal(kI * force, kI * feedback, kI * readout))
            .real();
    return 2 * (real * real + imaginary * imaginary);
  };
  const Matrix2cd force = force_root(density.force).cast<Complex>();
  const Vector2cd none = Vector2cd::Zero();
  const double charge = power(none, 1, 0) + power(none, 0, 1);
  return {std::sqrt(power(force.col(0), 0, 0) + power(force.col(1), 0, 0)),
          std::sqrt(charge * density.dielectric),
          std::sqrt(charge * density.amplifier)};
}

double sensing_angle_random_walk(const TrimmedGyro& gyro) {
  return low_frequency_noise(gyro, kCalibrationTemperature,
                             kCalibrationTemperature)
             .total() /
         std::numbers::sqrt2;
}

NoiseParameters output_noise(const TrimmedGyro& gyro) {
  return with_white_noise(gyro.device.noise, sensing_angle_random_walk(gyro));
}

}  // namespace beamgyro::internal
