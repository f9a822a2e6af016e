// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro {
namespace {

// Chebyshev node i of n on [-1, 1].
double node(int i, int n) { return std::cos(std::numbers::pi * (i + 0.5) / n); }

// T_0(x) .. T_{n-1}(x), a column each, one row for each x.
template <class Column, class Basis>
void chebyshev_basis(const Column& x, Basis& basis) {
  basis.col(0).setOnes();
  if (basis.cols() > 1) basis.col(1) = x;
  for (Eigen::Index k = 2; k < basis.cols(); ++k)
    basis.col(k) = 2 * x * basis.col(k - 1) - basis.col(k - 2);
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
double weighted(const Eigen::Vector4d& error) {
  return Eigen::Vector4d(1, 1, 2.8e-3, 0.17)
      .cwiseProduct(error)
      .cwiseAbs()
      .maxCoeff();
}

constexpr int kFrequency = 2;            // channel
constexpr double kSmallestPiece = 1e-3;  // [K]

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
  in_rate_ = node_transform(rate_degree_ + 1).transpose();
  in_temperature_ = node_transform(kTemperatureNodes).transpose();
  std::vector<double> cuts = modal_kinks(gyro.device);
  std::erase_if(cuts, [&](double T) { return T <= low || T >= high; });
  cuts.insert(cuts.end(), {low, high});
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] < cuts[i + 1]) refine(cuts[i], cuts[i + 1]);
  }
}

ModalParameters StaticMap::modal(double T) const {
  return modal_parameters(gyro_.device, gyro_.beam, T, gyro_.stiffness_trim);
}

Eigen::Vector4d StaticMap::exact(const ModalParameters& modal, double rate,
                                 double guess) {
  CaseMotion motion;
  motion.z = rate;
  const BeamSignal signal = beam_signal(gyro_, modal, motion, path_, guess);
  return {signal.demodulated.real(), signal.demodulated.imag(),
          signal.drive_frequency, signal.drive_voltage};
}

int StaticMap::needed_rate_degree(double low, double high) {
  if (rate_limit_ == 0) return 0;
  const Eigen::MatrixXd transform = node_transform(kMaxRates);
  int degree = 0;
  for (const double T : {low, 0.5 * (low + high), high}) {
    const ModalParameters at_T = modal(T);
    Eigen::Matrix<double, kChannels, kMaxRates> values;
    for (int i = 0; i < kMaxRates; ++i) {
      values.col(i) = exact(at_T, rate_limit_ * node(i, kMaxRates),
                            i > 0 ? values(kFrequency, i - 1) : 0);
    }
    const Eigen::MatrixXd coefficients = values * transform.transpose();
    for (int k = kMaxRates - 1; k > degree; --k) {
      if (weighted(coefficients.col(k)) > 0.1 * tolerance_) degree = k;
    }
  }
  if (degree == kMaxRates - 1) {
    throw SimulationFailure(fmt::format(
        "static map: rates of {:.0f} deg/s are too large for this device: the "
        "response is no smooth function of rate",
        rate_limit_ / kDegree));
  }
  return degree;
}

// None when the expansion at one of the rates shows that it is too short.
std::optional<StaticMap::Piece> StaticMap::fitted(double low, double high) {
  const int rates = rate_degree_ + 1;
  std::array<ModalParameters, kTemperatureNodes> at_node;
  std::array<Eigen::Matrix<double, kChannels, kTemperatureNodes>, kMaxRates>
      values;
  for (int i = 0; i < rates; ++i) {
    const auto rate = static_cast<std::size_t>(i);
    for (int j = 0; j < kTemperatureNodes; ++j) {
      ModalParameters& at_T = at_node[static_cast<std::size_t>(j)];
      if (i == 0) {
        at_T = modal(0.5 * (low + high) +
                     0.5 * (high - low) * node(j, kTemperatureNodes));
      }
      values[rate].col(j) = exact(at_T, rate_limit_ * node(i, rates),
                                  i > 0 ? values[rate - 1](kFrequency, j) : 0);
    }
    if (i > 0 || high - low < kSmallestPiece) continue;
    const Eigen::Vector4d last =
        values[rate] * in_temperature_.col(kTemperatureNodes - 1);
    if (weighted(last) > tolerance_) return {};
  }
  Piece piece{low, high, Eigen::MatrixXd(kChannels * rates, kTemperatureNodes)};
  for (int k = 0; k < rates; ++k) {
    Eigen::Matrix<double, kChannels, kTemperatureNodes> sum =
        values[0] * in_rate_(0, k);
    for (int i = 1; i < rates; ++i)
      sum += values[static_cast<std::size_t>(i)] * in_rate_(i, k);
    piece.coefficients.middleRows<kChannels>(kChannels * k) =
        sum * in_temperature_;
  }
  return piece;
}

double StaticMap::error(const Piece& piece) {
  // Between the outer nodes and the ends and near the middle, where the error
  // of Chebyshev interpolation is largest.
  constexpr std::array<double, 5> kProbes = {-1, -0.93, 0.2, 0.75, 1};
  double largest = 0;
  for (const double x : kProbes) {
    const double T =
        0.5 * (piece.low + piece.high) + 0.5 * (piece.high - piece.low) * x;
    const ModalParameters at_T = modal(T);
    double guess = 0;
    for (const double rate : {0.0, -0.97 * rate_limit_, rate_limit_}) {
      const Eigen::Vector4d want = exact(at_T, rate, guess);
      const Channels have = channels(piece, {&T, 1}, {&rate, 1});
      largest = std::max(
          largest, weighted(have.at_rate.row(0).matrix().transpose() - want));
      if (rate_limit_ == 0) break;
      guess = want(kFrequency);
    }
  }
  return largest;
}

void StaticMap::refine(double low, double high) {
  std::optional<Piece> piece = fitted(low, high);
  // The rest of the tolerance is left for the points between the probes.
  if (piece &&
      (high - low < kSmallestPiece || error(*piece) <= 0.25 * tolerance_)) {
    pieces_.push_back(std::move(*piece));
    return;
  }
  const double middle = 0.5 * (low + high);
  refine(low, middle);
  refine(middle, high);
}

StaticMap::Channels StaticMap::channels(const Piece& piece,
                                        std::span<const double> T,
                                        std::span<const double> rate) const {
  using Samples = Eigen::Map<const Eigen::ArrayXd>;
  const auto n = static_cast<Eigen::Index>(T.size());
  Lanes<kTemperatureNodes> over_T(n, kTemperatureNodes);
  chebyshev_basis((2 * Samples(T.data(), n) - piece.low - piece.high) /
                      (piece.high - piece.low),
                  over_T);
  Lanes<Eigen::Dynamic> over_rate(n, rate_degree_ + 1);
  if (rate_degree_ > 0)
    chebyshev_basis(Samples(rate.data(), n) / rate_limit_, over_rate);

  Channels sum{Lanes<kChannels>(n, kChannels), Lanes<kChannels>(n, kChannels)};
  Lanes<1> value(n);
  for (int c = 0; c < kChannels * (rate_degree_ + 1); ++c) {
    const int channel = c % kChannels, k = c / kChannels;
    value.setConstant(piece.coefficients(c, 0));
    for (int j = 1; j < kTemperatureNodes; ++j)
      value += piece.coefficients(c, j) * over_T.col(j);
    if (k == 0) {
      sum.at_rate.col(channel) = sum.at_rest.col(channel) = value;
      continue;
    }
    sum.at_rate.col(channel) += over_rate.col(k) * value;
    if (k % 2 == 0)  // T_k(0) = 1, 0, -1, 0, 1, ...
      sum.at_rest.col(channel) += (k % 4 == 0 ? 1.0 : -1.0) * value;
  }
  return sum;
}

const StaticMap::Piece& StaticMap::piece_at(double T) const {
  const auto after = std::upper_bound(
      pieces_.begin() + 1, pieces_.end(), T,
      [](double value, const Piece& piece) { return value < piece.low; });
  return *(after - 1);
}

BeamSignal StaticMap::limited(const Eigen::Vector4d& v) const {
  const bool locked = v(3) <= voltage_limit_;
  const double share = locked ? 1.0 : voltage_limit_ / v(3);
  return {share * Complex(v(0), v(1)), v(kFrequency), share * v(3), locked};
}

StaticMap::Signals StaticMap::at(double T, double rate) const {
  Signals signals;
  sample({&T, 1}, {&rate, 1}, {&signals, 1});
  return signals;
}

void StaticMap::sample(std::span<const double> T, std::span<const double> rate,
                       std::span<Signals> signals) const {
  assert(rate.size() == T.size() && signals.size() == T.size());
  std::size_t count = 0;
  for (std::size_t first = 0; first < T.size(); first += count) {
    const Piece& piece = piece_at(T[first]);
    const bool last = &piece == &pieces_.back();
    count = 1;
    while (count < kBlock && first + count < T.size() &&
           (&piece == &pieces_.front() || T[first + count] >= piece.low) &&
           (last || T[first + count] < piece.high))
      ++count;
    const Channels c =
        channels(piece, T.subspan(first, count), rate.subspan(first, count));
    for (std::size_t i = 0; i < count; ++i) {
      assert(T[first + i] > pieces_.front().low - 1e-6 &&
             T[first + i] < pieces_.back().high + 1e-6);
      assert(std::abs(rate[first + i]) <= rate_limit_ * (1 + 1e-9));
      const auto row = static_cast<Eigen::Index>(i);
      const BeamSignal at_rest = limited(c.at_rest.row(row));
      signals[first + i] = {
          rate[first + i] == 0 ? at_rest : limited(c.at_rate.row(row)),
          at_rest.demodulated};
    }
  }
}

}  // namespace beamgyro
