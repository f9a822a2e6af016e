// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace beamgyro {
namespace {

constexpr int kMaxRateDegree = 11;

// Chebyshev node i of n on [-1, 1].
double node(int i, int n) { return std::cos(std::numbers::pi * (i + 0.5) / n); }

// T_0(x) .. T_{n-1}(x).
template <class Vector>
void chebyshev_basis(double x, Vector& basis) {
  basis(0) = 1;
  if (basis.size() > 1) basis(1) = x;
  for (Eigen::Index k = 2; k < basis.size(); ++k)
    basis(k) = 2 * x * basis(k - 1) - basis(k - 2);
}

// Matrix that turns values at n Chebyshev nodes into n coefficients.
Eigen::MatrixXd node_transform(int n) {
  Eigen::MatrixXd transform(n, n);
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      transform(k, i) = (k == 0 ? 1.0 : 2.0) / n *
                        std::cos(std::numbers::pi * k * (i + 0.5) / n);
    }
  }
  return transform;
}

// The error a table may have in frequency [rad/s] and voltage [V], per rad/s of
// the signal's tolerance: 1e-6 deg/s go with 1e-6 Hz and 1e-7 V.
const Eigen::Vector4d kChannelWeight(1, 1, 2.8e-3, 0.17);

}  // namespace

StaticMap::StaticMap(const Gyro& gyro, double low, double high,
                     double rate_limit, double tolerance)
    : gyro_(gyro),
      rate_limit_(rate_limit),
      tolerance_(tolerance),
      voltage_limit_(gyro.loop.voltage_limit) {
  // The limit is a kink: the table holds the unlimited response, and at()
  // scales it, which is exact because the beam is linear.
  gyro_.loop.voltage_limit = std::numeric_limits<double>::infinity();
  constexpr double kMargin = 1e-3;  // [K]
  low -= kMargin;
  high += kMargin;
  rate_degree_ = needed_rate_degree(low, high);
  refine(low, high);
}

Eigen::Vector4d StaticMap::exact(const ModalParameters& modal,
                                 double rate) const {
  CaseMotion motion;
  motion.z = rate;
  const BeamSignal signal = beam_signal(gyro_, modal, motion);
  return {signal.demodulated.real(), signal.demodulated.imag(),
          signal.drive_frequency, signal.drive_voltage};
}

int StaticMap::needed_rate_degree(double low, double high) const {
  if (rate_limit_ == 0) return 0;
  const Eigen::MatrixXd transform = node_transform(kMaxRateDegree + 1);
  int degree = 0;
  for (const double T : {low, 0.5 * (low + high), high}) {
    const ModalParameters modal =
        modal_parameters(gyro_.device, gyro_.beam, T, gyro_.stiffness_trim);
    Eigen::Matrix<double, kChannels, kMaxRateDegree + 1> values;
    for (int i = 0; i <= kMaxRateDegree; ++i)
      values.col(i) = exact(modal, rate_limit_ * node(i, kMaxRateDegree + 1));
    const Eigen::MatrixXd coefficients = values * transform.transpose();
    for (int k = kMaxRateDegree; k > degree; --k) {
      const Eigen::Array4d size =
          coefficients.col(k).cwiseProduct(kChannelWeight).cwiseAbs();
      if (size.maxCoeff() > 0.1 * tolerance_) degree = k;
    }
  }
  if (degree == kMaxRateDegree) {
    throw std::runtime_error(fmt::format(
        "static map: rates of {:.0f} deg/s are too large for this device: the "
        "response is no smooth function of rate",
        rate_limit_ * 180 / std::numbers::pi));
  }
  return degree;
}

StaticMap::Piece StaticMap::fitted(double low, double high) const {
  const int rates = rate_degree_ + 1;
  const Eigen::MatrixXd in_rate = node_transform(rates);
  Eigen::MatrixXd values(kChannels * rates, kTemperatureNodes);
  Eigen::MatrixXd row(kChannels, rates);
  for (int j = 0; j < kTemperatureNodes; ++j) {
    const double T =
        0.5 * (low + high) + 0.5 * (high - low) * node(j, kTemperatureNodes);
    const ModalParameters modal =
        modal_parameters(gyro_.device, gyro_.beam, T, gyro_.stiffness_trim);
    for (int i = 0; i < rates; ++i)
      row.col(i) = exact(modal, rate_limit_ * node(i, rates));
    values.col(j) = (row * in_rate.transpose()).reshaped();
  }
  return {low, high, values * node_transform(kTemperatureNodes).transpose()};
}

double StaticMap::error(const Piece& piece) const {
  // Between the outer nodes and the ends and near the middle, where the error
  // of Chebyshev interpolation is largest.
  constexpr std::array<double, 5> kProbes = {-1, -0.93, 0.2, 0.75, 1};
  double largest = 0;
  for (const double x : kProbes) {
    const double T =
        0.5 * (piece.low + piece.high) + 0.5 * (piece.high - piece.low) * x;
    const ModalParameters modal =
        modal_parameters(gyro_.device, gyro_.beam, T, gyro_.stiffness_trim);
    const Collapsed in_rate = collapsed(piece, T);
    for (const double rate : {0.0, -0.97 * rate_limit_, rate_limit_}) {
      const Eigen::Array4d difference =
          (evaluated(in_rate, rate) - exact(modal, rate))
              .cwiseProduct(kChannelWeight)
              .cwiseAbs();
      largest = std::max(largest, difference.maxCoeff());
      if (rate_limit_ == 0) break;
    }
  }
  return largest;
}

void StaticMap::refine(double low, double high) {
  constexpr double kSmallestPiece = 1e-3;  // [K]
  Piece piece = fitted(low, high);
  // The rest of the tolerance is left for the points between the probes.
  if (high - low < kSmallestPiece || error(piece) <= 0.25 * tolerance_) {
    pieces_.push_back(std::move(piece));
    return;
  }
  const double middle = 0.5 * (low + high);
  refine(low, middle);
  refine(middle, high);
}

StaticMap::Collapsed StaticMap::collapsed(const Piece& piece, double T) const {
  Eigen::Matrix<double, kTemperatureNodes, 1> basis;
  chebyshev_basis((2 * T - piece.low - piece.high) / (piece.high - piece.low),
                  basis);
  return piece.coefficients * basis;
}

Eigen::Vector4d StaticMap::evaluated(const Collapsed& in_rate,
                                     double rate) const {
  Eigen::Vector4d sum = in_rate.head<kChannels>();
  if (rate_degree_ == 0) return sum;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRateDegree + 1, 1> basis(
      rate_degree_ + 1);
  chebyshev_basis(rate / rate_limit_, basis);
  for (int k = 1; k <= rate_degree_; ++k)
    sum += basis(k) * in_rate.segment<kChannels>(kChannels * k);
  return sum;
}

const StaticMap::Piece& StaticMap::piece_at(double T) const {
  const auto after = std::upper_bound(
      pieces_.begin() + 1, pieces_.end(), T,
      [](double value, const Piece& piece) { return value < piece.low; });
  return *(after - 1);
}

StaticMap::Signals StaticMap::at(double T, double rate) const {
  assert(T > pieces_.front().low - 1e-6 && T < pieces_.back().high + 1e-6);
  assert(std::abs(rate) <= rate_limit_ * (1 + 1e-9));
  const Collapsed in_rate = collapsed(piece_at(T), T);
  const auto limited = [&](const Eigen::Vector4d& v) {
    const bool locked = v(3) <= voltage_limit_;
    const double share = locked ? 1.0 : voltage_limit_ / v(3);
    return BeamSignal{share * Complex(v(0), v(1)), v(2), share * v(3), locked};
  };
  const BeamSignal at_rest = limited(evaluated(in_rate, 0));
  if (rate == 0) return {at_rest, at_rest.demodulated};
  return {limited(evaluated(in_rate, rate)), at_rest.demodulated};
}

}  // namespace beamgyro
