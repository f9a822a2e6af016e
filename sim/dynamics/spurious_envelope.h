// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// A spurious mode as the runs that simulate the loops have it: per unit modal
/// mass, with its coordinate divided by sqrt(m) A_ref,
///
///   Q'' + width Q' + square Q + g^T (X, Y) = 0,
///   acceleration of (X, Y) = -g Q,   g = w_0^2 (e_x, e_y)            (13.1)
struct SpuriousOscillator {
  double square;             // w_s^2 [1/s2]
  double width;              // eta_s w_s [1/s]
  Eigen::Vector2d coupling;  // g [1/s2]
  double square_slope;       // d square/dT_s [1/s2/K]
  double width_slope;        // d width/dT_s [1/s/K]
  bool follows_housing;      // T_s
};

/// The spurious modes of one gyro for those runs.
class SpuriousOscillators {
 public:
  explicit SpuriousOscillators(const TrimmedGyro& gyro);

  Eigen::Index count() const {
    return static_cast<Eigen::Index>(modes_.size());
  }
  /// Returns whether age or hysteresis moves them.
  bool have_memory() const { return have_memory_; }

  /// Returns the modes at one moment, valid until the next call.
  const std::vector<SpuriousOscillator>& at(
      const SpuriousTemperatures& temperatures, const MemoryState& memory);

 private:
  std::vector<SpuriousModeParameters> modes_;
  double reference_, mass_;
  bool have_memory_;
  std::vector<SpuriousOscillator> now_;
};

/// Returns the error of each real state of the modes, two a mode, that matters
/// as much as one of 1 rad/s in the output: an error dQ is an acceleration
/// w_0^2 e dQ, which is worth w_0 e dQ/2.
Eigen::VectorXd spurious_error_weights(const TrimmedGyro& gyro);

/// The amplitudes Z_s of the spurious modes, Q = Re[Z e^{i theta}], on the slow
/// manifold of (2.13) together with those of the beam: with n + 2 coordinates,
/// of which only (X, Y) are forced,
///
///   r = 1/(2 i w + width),  S = square - w^2 + i w width,
///   v = -r (S Z + g^T U),   v_U = R (f - S_0 U - sum g Z),
///   Z' = v + r^2 (S v + g^T v_U).
///
/// On the beam they act as the force -sum g Z with the rate of change -sum g v.
/// The steady state is that of (13.3).
class SpuriousEnvelope {
 public:
  using Amplitudes = Eigen::VectorXcd;

  SpuriousEnvelope(const std::vector<SpuriousOscillator>& modes, double omega,
                   const Eigen::Vector2cd& U, const Amplitudes& Z);

  const Eigen::Vector2cd& force() const { return force_; }
  const Eigen::Vector2cd& force_rate() const { return force_rate_; }

  /// Returns Z'; `v_U` belongs to the force that contains force().
  Amplitudes rates(const Eigen::Vector2cd& v_U) const;

  /// Derivatives of what a mode does by its own parameters.
  struct Slope {
    Eigen::Vector2cd force_rate;  // of the sum over all modes
    Amplitudes rates;             // without what comes through v_U
  };
  Slope by_frequency(const Eigen::Vector2cd& v_U) const;
  /// By the temperature of the housing or of the beam.
  Slope by_temperature(const Eigen::Vector2cd& v_U, bool of_housing) const;

  /// Derivatives by the amplitudes U (two columns) and Z, and by v_U.
  struct Couplings {
    Eigen::Matrix2cd force_rate_by_U;
    Eigen::Matrix2Xcd force_by_Z, force_rate_by_Z;
    Eigen::MatrixX2cd rates_by_U;  // without what comes through v_U
    Amplitudes rates_by_own;       // likewise
    Eigen::MatrixX2cd rates_by_v;  // r^2 g^T
  };
  Couplings couplings() const;

 private:
  struct Mode {
    Eigen::Vector2d g;
    std::complex<double> r, S, v;
  };
  Slope slope(const Eigen::Vector2cd& v_U,
              const std::vector<std::complex<double>>& dP,
              const std::vector<std::complex<double>>& dS) const;

  const std::vector<SpuriousOscillator>& oscillators_;
  double omega_;
  Amplitudes Z_;
  std::vector<Mode> modes_;
  Eigen::Vector2cd U_, force_, force_rate_;
};

}  // namespace beamgyro::internal
