// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "sim/dynamics/gyro.h"

namespace beamgyro {

/// Static response of one gyro, tabulated over a range of beam temperatures and
/// rates, so that a sample costs some ten nanoseconds. The table holds
/// Chebyshev polynomials in temperature, times one Chebyshev polynomial in
/// rate. Pieces end at the kinks of the materials and are halved until the
/// table agrees with the exact solution (2.10).
class StaticMap {
 public:
  /// Tabulates temperatures in [low, high] [K] and rates up to +-`rate_limit`
  /// [rad/s]. The error of the demodulated signal stays below `tolerance`
  /// [rad/s]; the default is 1e-6 deg/s.
  StaticMap(const Gyro& gyro, double low, double high, double rate_limit,
            double tolerance = 1.7e-8);

  struct Signals {
    BeamSignal at_rate;
    std::complex<double> at_rest;  // demodulated, twin at rate 0 [rad/s]
  };
  /// Returns the response at T [K], which must lie in the tabulated range (to
  /// 1e-6 K), and at a rate [rad/s] below the limit.
  Signals at(double T, double rate) const;

  /// Writes at() of every pair of T and rate. The three spans have the same
  /// length.
  void sample(std::span<const double> T, std::span<const double> rate,
              std::span<Signals> signals) const;

  int pieces() const { return static_cast<int>(pieces_.size()); }
  int rate_degree() const { return rate_degree_; }

 private:
  // Re, Im of the demodulated signal, drive frequency, voltage.
  static constexpr int kChannels = 4;
  static constexpr int kTemperatureNodes = 10, kMaxRates = 12;
  static constexpr Eigen::Index kBlock = 64;  // samples at a time
  template <int kColumns>
  using Lanes = Eigen::Array<double, Eigen::Dynamic, kColumns, 0, kBlock,
                             kColumns == Eigen::Dynamic ? kMaxRates : kColumns>;

  struct Piece {
    double low, high;              // [K]
    Eigen::MatrixXd coefficients;  // (channel x rate degree) x temperature node
  };
  struct Channels {  // one row a sample
    Lanes<kChannels> at_rate, at_rest;
  };

  ModalParameters modal(double T) const;
  Eigen::Vector4d exact(const ModalParameters& modal, double rate,
                        double guess = 0);
  std::optional<Piece> fitted(double low, double high);
  double error(const Piece& piece);
  void refine(double low, double high);
  int needed_rate_degree(double low, double high);
  Channels channels(const Piece& piece, std::span<const double> T,
                    std::span<const double> rate) const;
  BeamSignal limited(const Eigen::Vector4d& channels) const;
  const Piece& piece_at(double T) const;

  Gyro gyro_;
  LockPath path_;
  double rate_limit_, tolerance_;
  double voltage_limit_;
  int rate_degree_ = 0;
  Eigen::MatrixXd in_rate_, in_temperature_;  // node_transform() of each
  std::vector<Piece> pieces_;
};

}  // namespace beamgyro
