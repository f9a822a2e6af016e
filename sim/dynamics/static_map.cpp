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
constexpr int kGlassAxis = 0;            // of the memory states
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
  tabulate(low, high);
}

StaticMap::StaticMap(const Gyro& gyro, double low, double high,
                     double rate_limit, MemoryBounds bounds, double tolerance)
    : gyro_(gyro),
      bounds_(std::move(bounds)),
      rate_limit_(rate_limit),
      tolerance_(tolerance),
      voltage_limit_(gyro.loop.voltage_limit) {
  gyro_.loop.voltage_limit = std::numeric_limits<double>::infinity();
  MemoryBox whole = memory_box(low, high);
  for (int axis = kMemoryAxes - 1; axis > kGlassAxis; --axis) {
    memory_nodes_[static_cast<std::size_t>(axis)] =
        needed_memory_nodes(low, high, whole, axis);
  }
  tabulate(low, high);
}

void StaticMap::tabulate(double low, double high) {
  constexpr double kMargin = 1e-3;  // [K]
  low -= kMargin;
  high += kMargin;
  rate_degree_ = needed_rate_degree(low, high);
  in_rate_ = node_transform(rate_degree_ + 1).transpose();
  in_temperature_ = node_transform(kTemperatureNodes).transpose();
  std::vector<double> cuts = modal_kinks(gyro_.device);
  std::erase_if(cuts, [&](double T) { return T <= low || T >= high; });
  cuts.insert(cuts.end(), {low, high});
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] < cuts[i + 1]) refine(cuts[i], cuts[i + 1]);
  }
}

ModalParameters StaticMap::modal(double T, const MemoryState& memory) const {
  return modal_parameters(gyro_.device, gyro_.beam, T, gyro_.stiffness_trim,
                          memory);
}

MemoryState StaticMap::MemoryBox::state(const MemoryPoint& place) const {
  return {middle[0] + half[0] * place[0], middle[1] + half[1] * place[1],
          middle[2] + half[2] * place[2]};
}

MemoryState StaticMap::MemoryBox::node_state(int index) const {
  MemoryPoint place{};
  for (std::size_t axis = 0; axis < kMemoryAxes; ++axis) {
    place[axis] = node(index % nodes[axis], nodes[axis]);
    index /= nodes[axis];
  }
  return state(place);
}

// Turns values at the nodes, a column each, into coefficients.
Eigen::MatrixXd StaticMap::MemoryBox::transform() const {
  std::array<Eigen::MatrixXd, kMemoryAxes> along;
  for (std::size_t axis = 0; axis < kMemoryAxes; ++axis)
    along[axis] = node_transform(nodes[axis]);
  Eigen::MatrixXd transform(size(), size());
  for (int to = 0; to < size(); ++to) {
    for (int from = 0; from < size(); ++from) {
      double product = 1;
      int i = from, k = to;
      for (std::size_t axis = 0; axis < kMemoryAxes; ++axis) {
        product *= along[axis](k % nodes[axis], i % nodes[axis]);
        i /= nodes[axis];
        k /= nodes[axis];
      }
      transform(from, to) = product;
    }
  }
  return transform;
}

// With the numbers of nodes that hold for all pieces.
StaticMap::MemoryBox StaticMap::memory_box(double low, double high) {
  MemoryBox box;
  if (!bounds_) return box;
  const auto [least, most] = bounds_(low, high);
  const MemoryPoint a = {least.glass_offset, least.hysteresis, least.decades};
  const MemoryPoint b = {most.glass_offset, most.hysteresis, most.decades};
  for (std::size_t axis = 0; axis < kMemoryAxes; ++axis) {
    box.middle[axis] = 0.5 * (a[axis] + b[axis]);
    box.half[axis] = 0.5 * (b[axis] - a[axis]);
  }
  box.nodes = memory_nodes_;
  return box;
}

// How many polynomials along one axis bring the response at rest within a tenth
// of the tolerance, the other axes at their middle.
int StaticMap::needed_memory_nodes(double low, double high, MemoryBox box,
                                   int axis) {
  const auto i = static_cast<std::size_t>(axis);
  if (box.half[i] == 0) return 1;
  int needed = 1;
  for (const int count : {4, kMaxMemoryNodes}) {
    const Eigen::MatrixXd transform = node_transform(count).transpose();
    needed = 1;
    for (const double T : {low, 0.5 * (low + high), high}) {
      Eigen::MatrixXd values(kChannels, count);
      for (int k = 0; k < count; ++k) {
        MemoryPoint place{};
        place[i] = node(k, count);
        values.col(k) = exact(modal(T, box.state(place)), 0,
                              k > 0 ? values(kFrequency, k - 1) : 0);
      }
      const Eigen::MatrixXd coefficients = values * transform;
      for (int k = count - 1; k >= needed; --k) {
        if (weighted(coefficients.col(k)) > 0.1 * tolerance_) needed = k + 1;
      }
    }
    if (needed < count) break;
  }
  return needed;
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
    const ModalParameters at_T = modal(T, memory_box(T, T).state({}));
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
  constexpr int kBlockRows = kChannels * kTemperatureNodes;
  const int rates = rate_degree_ + 1;
  MemoryBox box = memory_box(low, high);
  box.nodes[kGlassAxis] = needed_memory_nodes(low, high, box, kGlassAxis);
  std::array<ModalParameters, kTemperatureNodes> at_node;
  using Values = Eigen::Matrix<double, kChannels, kTemperatureNodes>;
  // A column for each memory node, of the values at every rate.
  Eigen::MatrixXd nodes(kBlockRows * rates, box.size());
  const auto values = [&](int memory, int rate) {
    return Eigen::Map<Values>(nodes.col(memory).data() + kBlockRows * rate);
  };
  for (int m = 0; m < box.size(); ++m) {
    const MemoryState state = box.node_state(m);
    for (int i = 0; i < rates; ++i) {
      for (int j = 0; j < kTemperatureNodes; ++j) {
        ModalParameters& at_T = at_node[static_cast<std::size_t>(j)];
        if (i == 0) {
          at_T = modal(0.5 * (low + high) +
                           0.5 * (high - low) * node(j, kTemperatureNodes),
                       state);
        }
        const double guess = i > 0   ? values(m, i - 1)(kFrequency, j)
                             : m > 0 ? values(0, 0)(kFrequency, j)
                                     : 0;
        values(m, i).col(j) = exact(at_T, rate_limit_ * node(i, rates), guess);
      }
      if (i > 0 || high - low < kSmallestPiece) continue;
      const Eigen::Vector4d last =
          values(m, i) * in_temperature_.col(kTemperatureNodes - 1);
      if (weighted(last) > tolerance_) return {};
    }
  }
  if (box.size() > 1) nodes = nodes * box.transform();
  Piece piece{
      low, high,
      Eigen::MatrixXd(kChannels * rates * box.size(), kTemperatureNodes), box};
  for (int m = 0; m < box.size(); ++m) {
    for (int k = 0; k < rates; ++k) {
      Values sum = values(m, 0) * in_rate_(0, k);
      for (int i = 1; i < rates; ++i) sum += values(m, i) * in_rate_(i, k);
      piece.coefficients.middleRows<kChannels>(kChannels * (k + rates * m)) =
          sum * in_temperature_;
    }
  }
  if (box.size() > 1) prune(piece);
  return piece;
}

// Memory changes the response by little: most of its rows need few terms, or
// none.
void StaticMap::prune(Piece& piece) const {
  const Eigen::Index rows = piece.coefficients.rows();
  const double allowed =
      0.05 * tolerance_ * kChannels / static_cast<double>(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    int terms = kTemperatureNodes;
    double dropped = 0;
    for (; terms > 0; --terms) {
      Eigen::Vector4d part = Eigen::Vector4d::Zero();
      part(row % kChannels) = piece.coefficients(row, terms - 1);
      dropped += weighted(part);
      if (dropped > allowed) break;
    }
    piece.terms.push_back(terms);
  }
}

double StaticMap::error(const Piece& piece) {
  // Between the outer nodes and the ends and near the middle, where the error
  // of Chebyshev interpolation is largest.
  constexpr std::array<double, 5> kProbes = {-1, -0.93, 0.2, 0.75, 1};
  double largest = 0;
  for (const double x : kProbes) {
    const double T =
        0.5 * (piece.low + piece.high) + 0.5 * (piece.high - piece.low) * x;
    const MemoryState memory = piece.memory.state({x, 0.9 * x, -0.9});
    const ModalParameters at_T = modal(T, memory);
    double guess = 0;
    for (const double rate : {0.0, -0.97 * rate_limit_, rate_limit_}) {
      const Eigen::Vector4d want = exact(at_T, rate, guess);
      const Channels have = channels(piece, {&T, 1}, {&rate, 1}, {&memory, 1});
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

// What the memory states of a block of samples add to the rows of a piece.
class StaticMap::MemoryResponse {
 public:
  MemoryResponse(const StaticMap& map, const Piece& piece,
                 const Lanes<kTemperatureNodes>& over_T,
                 std::span<const MemoryState> memory)
      : piece_(piece), over_T_(over_T), rows_(kChannels * map.in_rate_.rows()) {
    const MemoryBox& box = piece.memory;
    if (box.size() == 1) return;
    basis_.resize(over_T.rows(), box.size());
    const auto glass = map.memory_basis(box, 0, memory);
    const auto hysteresis = map.memory_basis(box, 1, memory);
    const auto decades = map.memory_basis(box, 2, memory);
    for (int m = 0; m < box.size(); ++m) {
      const int i = m % box.nodes[0], rest = m / box.nodes[0];
      basis_.col(m) = glass.col(i) * hysteresis.col(rest % box.nodes[1]) *
                      decades.col(rest / box.nodes[1]);
    }
  }

  // Adds to `value`, which is that of the first polynomials, of row `c`.
  template <class Value>
  void add(int c, Value& value) const {
    for (Eigen::Index m = 1; m < basis_.cols(); ++m) {
      const Eigen::Index row = c + rows_ * m;
      const int terms = piece_.terms[static_cast<std::size_t>(row)];
      if (terms == 0) continue;
      Lanes<1> part =
          Lanes<1>::Constant(value.rows(), piece_.coefficients(row, 0));
      for (int j = 1; j < terms; ++j)
        part += piece_.coefficients(row, j) * over_T_.col(j);
      value += part * basis_.col(m);
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

  Channels sum{Lanes<kChannels>(n, kChannels), Lanes<kChannels>(n, kChannels)};
  Lanes<1> value(n);
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
    const Channels c =
        channels(piece, T.subspan(first, count), rate.subspan(first, count),
                 memory.empty() ? memory : memory.subspan(first, count));
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
