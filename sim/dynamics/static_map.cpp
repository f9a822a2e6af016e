// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "sim/dynamics/chebyshev.h"

namespace beamgyro::internal {

// channels() of one sample, at its rate.
Eigen::Vector4d StaticMap::value(const Piece& piece, double T, double rate,
                                 const MemoryState& memory) const {
  Lanes<1> x(1);
  x(0) = (2 * T - piece.low - piece.high) / (piece.high - piece.low);
  Lanes<kTemperatureNodes> over_T(1, kTemperatureNodes);
  chebyshev_basis(x, over_T);
  x(0) = rate_limit_ > 0 ? rate / rate_limit_ : 0;
  Lanes<Eigen::Dynamic> over_rate(1, rate_degree_ + 1);
  chebyshev_basis(x, over_rate);
  std::array<Lanes<Eigen::Dynamic>, kMemoryAxes> along;
  for (int axis = 0; axis < kMemoryAxes; ++axis)
    along[static_cast<std::size_t>(axis)] =
        memory_basis(piece.memory, axis, {&memory, 1});
  const std::array<int, kMemoryAxes>& nodes = piece.memory.nodes;
  const int rows = kChannels * (rate_degree_ + 1);
  const auto add = [&](int m, Eigen::Vector4d& sum) {
    const double share = along[0](0, m % nodes[0]) *
                         along[1](0, m / nodes[0] % nodes[1]) *
                         along[2](0, m / nodes[0] / nodes[1]);
    for (int c = 0; c < rows; ++c) {
      const int row = c + rows * m;
      double part = 0;
      for (int j = 0; j < piece.terms[static_cast<std::size_t>(row)]; ++j)
        part += piece.coefficients(row, j) * over_T(0, j);
      sum(c % kChannels) += part * over_rate(0, c / kChannels) * share;
    }
  };
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  add(0, sum);
  for (const int m : piece.memory_terms) add(m, sum);
  return sum;
}

// What the memory states of a block of samples add to the rows of a piece.
class StaticMap::MemoryResponse {
 public:
  MemoryResponse(const StaticMap& map, const Piece& piece,
                 const Lanes<kTemperatureNodes>& over_T,
                 std::span<const MemoryState> memory)
      : piece_(piece), over_T_(over_T), rows_(kChannels * map.in_rate_.rows()) {
    const MemoryBox& box = piece.memory;
    if (box.size() == 1) return;
    basis_.resize(over_T.rows(),
                  static_cast<Eigen::Index>(piece.memory_terms.size()));
    const auto glass = map.memory_basis(box, 0, memory);
    const auto hysteresis = map.memory_basis(box, 1, memory);
    const auto decades = map.memory_basis(box, 2, memory);
    for (Eigen::Index k = 0; k < basis_.cols(); ++k) {
      const int m = piece.memory_terms[static_cast<std::size_t>(k)];
      const int i = m % box.nodes[0], rest = m / box.nodes[0];
      basis_.col(k) = glass.col(i) * hysteresis.col(rest % box.nodes[1]) *
                      decades.col(rest / box.nodes[1]);
    }
  }

  // Adds to `value`, which is that of the first polynomials, of row `c`.
  template <class Value>
  void add(int c, Value& value) const {
    for (Eigen::Index k = 0; k < basis_.cols(); ++k) {
      const Eigen::Index row =
          c + rows_ * piece_.memory_terms[static_cast<std::size_t>(k)];
      const int terms = piece_.terms[static_cast<std::size_t>(row)];
      if (terms == 0) continue;
      Lanes<1> part =
          Lanes<1>::Constant(value.rows(), piece_.coefficients(row, 0));
      for (int j = 1; j < terms; ++j)
        part += piece_.coefficients(row, j) * over_T_.col(j);
      value += part * basis_.col(k);
    }
  }

 private:
  const Piece& piece_;
  const Lanes<kTemperatureNodes>& over_T_;
  Eigen::Index rows_;
  Eigen::ArrayXXd basis_;
};

StaticMap::Lanes<Eigen::Dynamic> StaticMap::memory_basis(
    const MemoryBox& box, int axis, std::span<const MemoryState> memory) const {
  const auto n = static_cast<Eigen::Index>(memory.size());
  const auto i = static_cast<std::size_t>(axis);
  Lanes<1> place(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const MemoryState& state = memory[static_cast<std::size_t>(k)];
    const MemoryPoint point = {state.glass_offset, state.hysteresis,
                               state.decades};
    place(k) = box.half[i] > 0 ? (point[i] - box.middle[i]) / box.half[i] : 0;
  }
  Lanes<Eigen::Dynamic> basis(n, box.nodes[i]);
  chebyshev_basis(place, basis);
  return basis;
}

StaticMap::Channels StaticMap::channels(
    const Piece& piece, std::span<const double> T, std::span<const double> rate,
    std::span<const MemoryState> memory) const {
  using Samples = Eigen::Map<const Eigen::ArrayXd>;
  const auto n = static_cast<Eigen::Index>(T.size());
  Lanes<kTemperatureNodes> over_T(n, kTemperatureNodes);
  chebyshev_basis((2 * Samples(T.data(), n) - piece.low - piece.high) /
                      (piece.high - piece.low),
                  over_T);
  Lanes<Eigen::Dynamic> over_rate(n, rate_degree_ + 1);
  if (rate_degree_ > 0)
    chebyshev_basis(Samples(rate.data(), n) / rate_limit_, over_rate);
  const MemoryResponse remembered(*this, piece, over_T, memory);

  Channels sum{Lanes<kChannels>(n, kChannels), Lanes<kChannels>(n, kChannels),
               Lanes<2>(without_ ? n : 0, 2)};
  Lanes<1> value(n);
  for (int c = 0; without_ && c < 2; ++c) {
    value.setConstant(piece.without_spurious(c, 0));
    for (int j = 1; j < kTemperatureNodes; ++j)
      value += piece.without_spurious(c, j) * over_T.col(j);
    sum.without_spurious.col(c) = value;
  }
  for (int c = 0; c < kChannels * (rate_degree_ + 1); ++c) {
    const int channel = c % kChannels, k = c / kChannels;
    value.setConstant(piece.coefficients(c, 0));
    for (int j = 1; j < kTemperatureNodes; ++j)
      value += piece.coefficients(c, j) * over_T.col(j);
    remembered.add(c, value);
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

// Where the voltage of the unit with spurious modes stands at its limit.
Complex StaticMap::without_spurious(const Piece& piece, double T) const {
  Lanes<1> x(1);
  x(0) = (2 * T - piece.low - piece.high) / (piece.high - piece.low);
  Lanes<kTemperatureNodes> over_T(1, kTemperatureNodes);
  chebyshev_basis(x, over_T);
  const Eigen::Vector3d v =
      piece.without_spurious * over_T.row(0).matrix().transpose();
  return std::min(1.0, voltage_limit_ / v(2)) * Complex(v(0), v(1));
}

StaticMap::Signals StaticMap::signals_of(const Piece& piece, double T,
                                         double rate,
                                         const Eigen::Vector4d& at_rate,
                                         const Eigen::Vector4d& at_rest,
                                         Complex without) const {
  assert(std::abs(rate) <= rate_limit_ * (1 + 1e-9));
  const BeamSignal rest = limited(at_rest);
  Signals signals = {rate == 0 ? rest : limited(at_rate), rest.demodulated,
                     rest.demodulated};
  if (without_)
    signals.without_spurious =
        rest.amplitude_locked ? without : without_spurious(piece, T);
  return signals;
}

// channels() of one sample without memory, in the same order of sums and so to
// the last bit, but the four channels at a time.
StaticMap::Signals StaticMap::single(const Piece& piece, double T,
                                     double rate) const {
  using Array4 = Eigen::Map<const Eigen::Array4d>;
  std::array<double, kTemperatureNodes> over_T;
  const double x = (2 * T - piece.low - piece.high) / (piece.high - piece.low);
  over_T[0] = 1;
  over_T[1] = x;
  for (std::size_t j = 2; j < over_T.size(); ++j)
    over_T[j] = 2 * x * over_T[j - 1] - over_T[j - 2];
  Complex without;
  if (without_) {
    Eigen::Array2d value = piece.without_spurious.col(0).head<2>();
    for (std::size_t j = 1; j < over_T.size(); ++j)
      value += piece.without_spurious.col(static_cast<Eigen::Index>(j))
                   .head<2>()
                   .array() *
               over_T[j];
    without = {value(0), value(1)};
  }
  const double r = rate_degree_ > 0 ? rate / rate_limit_ : 0;
  const Eigen::Index rows = piece.coefficients.rows();
  const auto of_degree = [&](int k) {
    const double* const first = piece.coefficients.data() + kChannels * k;
    Eigen::Array4d value = Array4(first);
    for (std::size_t j = 1; j < over_T.size(); ++j)
      value += Array4(first + static_cast<Eigen::Index>(j) * rows) * over_T[j];
    return value;
  };
  Eigen::Array4d at_rate = of_degree(0), at_rest = at_rate;
  double basis = r, before = 1;  // T_k(r), T_k-1(r)
  for (int k = 1; k <= rate_degree_; ++k) {
    const Eigen::Array4d value = of_degree(k);
    at_rate += basis * value;
    if (k % 2 == 0) at_rest += (k % 4 == 0 ? 1.0 : -1.0) * value;
    const double next = 2 * r * basis - before;
    before = basis;
    basis = next;
  }
  return signals_of(piece, T, rate, at_rate.matrix(), at_rest.matrix(),
                    without);
}

StaticMap::Signals StaticMap::at(double T, double rate,
                                 const MemoryState& memory) const {
  Signals signals;
  sample({&T, 1}, {&rate, 1}, {&memory, 1}, {&signals, 1});
  return signals;
}

void StaticMap::sample(std::span<const double> T, std::span<const double> rate,
                       std::span<const MemoryState> memory,
                       std::span<Signals> signals) const {
  assert(rate.size() == T.size() && signals.size() == T.size());
  assert(memory.size() == T.size() || (memory.empty() && !bounds_));
  std::size_t count = 0;
  for (std::size_t first = 0; first < T.size(); first += count) {
    const Piece& piece = piece_at(T[first]);
    const bool last = &piece == &pieces_.back();
    count = 1;
    while (count < kBlock && first + count < T.size() &&
           (&piece == &pieces_.front() || T[first + count] >= piece.low) &&
           (last || T[first + count] < piece.high))
      ++count;
    assert(T[first] > pieces_.front().low - 1e-6 &&
           T[first] < pieces_.back().high + 1e-6);
    if (count == 1 && piece.memory.size() == 1) {
      signals[first] = single(piece, T[first], rate[first]);
      continue;
    }
    const Channels c =
        channels(piece, T.subspan(first, count), rate.subspan(first, count),
                 memory.empty() ? memory : memory.subspan(first, count));
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Complex without = without_ ? Complex(c.without_spurious(row, 0),
                                                 c.without_spurious(row, 1))
                                       : Complex();
      signals[first + i] =
          signals_of(piece, T[first + i], rate[first + i], c.at_rate.row(row),
                     c.at_rest.row(row), without);
    }
  }
}

}  // namespace beamgyro::internal
