// SPDX-License-Identifier: MIT
// How the table of a StaticMap is made.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "config/units.h"
#include "sim/dynamics/chebyshev.h"
#include "sim/dynamics/spurious_bump.h"
#include "sim/dynamics/static_map.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

// The node opposite to number `index` along the first axis of two nodes where
// it is the second, and otherwise itself.
int mirror_of(int index, const std::array<int, 3>& nodes) {
  int stride = 1;
  for (const int n : nodes) {
    if (n == 2 && index / stride % n == 1) return index - stride;
    stride *= n;
  }
  return index;
}

constexpr double kNarrowGlass = 0.1;     // [K], where two polynomials do
constexpr int kMostFits = 400;           // of a unit with memory
constexpr double kSmallestPiece = 1e-3;  // [K]
constexpr double kMargin = 1e-3;         // beyond both ends [K]

// The values at rate `i` and memory node `m` of a matrix of lacking().
using RateBlock = Eigen::Matrix<double, 4, Eigen::Dynamic>;
Eigen::Map<RateBlock> rate_block(Eigen::MatrixXd& values, int m, int i,
                                 int count) {
  return {values.col(m).data() + Eigen::Index{4} * count * i, 4, count};
}

SimulationFailure unresolved(double low, double high) {
  return SimulationFailure(fmt::format(
      "static map: the response is no smooth function of the memory states of "
      "the beam at {:.3f} to {:.3f} degC",
      low - kZeroCelsius, high - kZeroCelsius));
}

}  // namespace

StaticMap::StaticMap(const TrimmedGyro& gyro, double low, double high,
                     double rate_limit, double tolerance)
    : StaticMap(gyro, low, high, rate_limit, MemoryBounds{}, tolerance) {}

StaticMap::StaticMap(const TrimmedGyro& gyro, double low, double high,
                     double rate_limit, MemoryBounds bounds, double tolerance)
    : gyro_(gyro),
      bounds_(std::move(bounds)),
      rate_limit_(rate_limit),
      tolerance_(tolerance),
      voltage_limit_(gyro.loop.voltage_limit) {
  // The limit is a kink: the table holds the unlimited response, and at()
  // scales it, which is exact because the beam is linear.
  if (gyro_.spurious_reference > 0) {
    without_ = without_spurious_modes(gyro_);
    without_->loop.voltage_limit = std::numeric_limits<double>::infinity();
    if (!bounds_) smooth_.emplace(gyro_, low - kMargin, high + kMargin);
  }
  gyro_.loop.voltage_limit = std::numeric_limits<double>::infinity();
  const MemoryBox whole = memory_box(low, high);
  const std::array<double, 3> places = {low, 0.5 * (low + high), high};
  for (int axis = kMemoryAxes - 1; axis > kGlassAxis; --axis) {
    memory_nodes_[static_cast<std::size_t>(axis)] =
        needed_memory_nodes(places, whole, axis);
  }
  tabulate(low, high);
}

void StaticMap::tabulate(double low, double high) {
  low -= kMargin;
  high += kMargin;
  rate_degree_ = needed_rate_degree(low, high);
  in_rate_ = chebyshev_transform(rate_degree_ + 1).transpose();
  in_temperature_ = chebyshev_transform(kTemperatureNodes).transpose();
  std::vector<double> cuts = modal_kinks(gyro_.device);
  std::erase_if(cuts, [&](double T) { return T <= low || T >= high; });
  cuts.insert(cuts.end(), {low, high});
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] < cuts[i + 1]) refine(cuts[i], cuts[i + 1]);
  }
}

// How many polynomials along one axis bring the response at rest within a tenth
// of the tolerance, the other axes at their middle.
int StaticMap::needed_memory_nodes(std::span<const double> temperatures,
                                   const MemoryBox& box, int axis) {
  const auto i = static_cast<std::size_t>(axis);
  if (box.half[i] == 0) return 1;
  if (axis == kGlassAxis && box.half[i] < kNarrowGlass) return 2;
  int needed = 1;
  for (const int count : {4, 8, kMaxMemoryNodes}) {
    const Eigen::MatrixXd transform = chebyshev_transform(count).transpose();
    needed = 1;
    for (const double T : temperatures) {
      Eigen::MatrixXd values(kChannels, count);
      for (int k = 0; k < count; ++k) {
        MemoryPoint place{};
        place[i] = chebyshev_node(k, count);
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

ModalParameters StaticMap::modal(double T, const MemoryState& memory) const {
  return smooth_ ? smooth_->at(gyro_, {T, T}) : modal_at(gyro_, T, memory);
}

// Where the response is fitted to rates: the ends, the middle, and the flank of
// each bump.
std::vector<double> StaticMap::rate_temperatures(double low, double high) {
  std::vector<double> temperatures = {low, 0.5 * (low + high), high};
  if (!smooth_) return temperatures;
  const auto drive_frequency = [&](double T) {
    return beam_signal(*without_, smooth_->at(*without_, {T, T}), {},
                       without_path_)
        .drive_frequency;
  };
  for (const SpuriousBump& bump :
       spurious_bumps(gyro_, low, high, drive_frequency)) {
    const double flank = bump.temperature + 0.3 * bump.width;
    if (flank < high) temperatures.push_back(flank);
  }
  return temperatures;
}

int StaticMap::needed_rate_degree(double low, double high) {
  if (rate_limit_ == 0) return 0;
  const Eigen::MatrixXd transform = chebyshev_transform(kMaxRates);
  int degree = 0;
  for (const double T : rate_temperatures(low, high)) {
    const ModalParameters at_T = modal(T, memory_box(T, T).state({}));
    Eigen::Matrix<double, kChannels, kMaxRates> values;
    for (int i = 0; i < kMaxRates; ++i) {
      values.col(i) = exact(at_T, rate_limit_ * chebyshev_node(i, kMaxRates),
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

// None when the expansion in temperature shows that it is too short.
std::optional<StaticMap::Piece> StaticMap::fitted(double low, double high) {
  MemoryBox box = memory_box(low, high);
  const std::array<double, 2> ends = {low, high};
  box.nodes[kGlassAxis] = needed_memory_nodes(ends, box, kGlassAxis);
  const Eigen::Index rows =
      Eigen::Index{kChannels} * (rate_degree_ + 1) * box.size();
  Piece piece{low, high, Eigen::MatrixXd::Zero(rows, kTemperatureNodes), box};
  if (!add_part(piece, {box.nodes[kGlassAxis], 1, 1}, kTemperatureNodes, false))
    return {};
  if (box.size() > 1) {
    if (!add_memory(piece)) return {};
    prune(piece);
  }
  if (without_) add_without_spurious(piece);
  return piece;
}

// The response without spurious modes is smoother than that with them, which
// the probes compare.
void StaticMap::add_without_spurious(Piece& piece) {
  Eigen::Matrix<double, 3, kTemperatureNodes> values;
  for (int j = 0; j < kTemperatureNodes; ++j) {
    const double T =
        0.5 * (piece.low + piece.high) +
        0.5 * (piece.high - piece.low) * chebyshev_node(j, kTemperatureNodes);
    const BeamSignal signal = beam_signal(
        *without_,
        smooth_ ? smooth_->at(*without_, {T, T}) : modal_at(*without_, T), {},
        without_path_);
    values.col(j) << signal.demodulated.real(), signal.demodulated.imag(),
        signal.drive_voltage;
  }
  piece.without_spurious = values * in_temperature_;
}

// Adds the expansion of what the piece lacks at `nodes` of the memory states
// and at so many temperatures. Of a pair it takes that to be odd along axes of
// two nodes. Adds nothing and returns false where the expansion in temperature
// is too short.
bool StaticMap::add_part(Piece& piece,
                         const std::array<int, kMemoryAxes>& nodes,
                         int temperature_nodes, bool is_pair) {
  MemoryBox box = piece.memory;
  box.nodes = nodes;
  const Eigen::MatrixXd in_temperature =
      temperature_nodes == kTemperatureNodes
          ? in_temperature_
          : chebyshev_transform(temperature_nodes).transpose();
  std::optional<Eigen::MatrixXd> values =
      lacking(piece, box, in_temperature, is_pair);
  if (!values) return false;
  if (box.size() > 1) *values = *values * box.transform();
  add_coefficients(piece, box, *values, in_temperature);
  return true;
}

// What the piece lacks: a column for each memory node, of a block for each rate
// with a row for each channel and a column for each temperature. None when the
// expansion in temperature is too short.
std::optional<Eigen::MatrixXd> StaticMap::lacking(
    const Piece& piece, const MemoryBox& box,
    const Eigen::MatrixXd& in_temperature, bool is_pair) {
  const bool is_first = piece.terms.empty();
  const int count = static_cast<int>(in_temperature.cols());
  const int rates = rate_degree_ + 1;
  const double allowed =
      count == kTemperatureNodes ? tolerance_ : 0.05 * tolerance_;
  Eigen::MatrixXd lacking(Eigen::Index{kChannels} * count * rates, box.size());
  std::vector<ModalParameters> at_node(static_cast<std::size_t>(count));
  Eigen::VectorXd at_last_rate(count), at_first_state(count);  // frequencies
  for (int m = 0; m < box.size(); ++m) {
    if (const int mirrored = is_pair ? mirror_of(m, box.nodes) : m;
        mirrored < m) {
      lacking.col(m) = -lacking.col(mirrored);
      continue;
    }
    const MemoryState state = box.node_state(m);
    for (int i = 0; i < rates; ++i) {
      const double rate = rate_limit_ * chebyshev_node(i, rates);
      auto values = rate_block(lacking, m, i, count);
      for (int j = 0; j < count; ++j) {
        ModalParameters& at_T = at_node[static_cast<std::size_t>(j)];
        const double T =
            0.5 * (piece.low + piece.high) +
            0.5 * (piece.high - piece.low) * chebyshev_node(j, count);
        if (i == 0) at_T = modal(T, state);
        Eigen::Vector4d have = Eigen::Vector4d::Zero();
        double guess = i > 0 ? at_last_rate(j) : m > 0 ? at_first_state(j) : 0;
        if (!is_first) {
          have = value(piece, T, rate, state);
          guess = have(kFrequency);
        }
        const Eigen::Vector4d want = exact(at_T, rate, guess);
        at_last_rate(j) = want(kFrequency);
        if (i == 0 && m == 0) at_first_state(j) = want(kFrequency);
        values.col(j) = is_first ? want : want - have;
      }
      if (i > 0 || piece.high - piece.low < kSmallestPiece) continue;
      const Eigen::Vector4d last = values * in_temperature.col(count - 1);
      if (weighted(last) > allowed) return {};
    }
  }
  return lacking;
}

// `values` as lacking() returns them, as coefficients of the memory states.
void StaticMap::add_coefficients(Piece& piece, const MemoryBox& box,
                                 Eigen::MatrixXd& values,
                                 const Eigen::MatrixXd& in_temperature) const {
  const bool is_first = piece.terms.empty();
  const int count = static_cast<int>(in_temperature.cols());
  const int rates = rate_degree_ + 1;
  const std::array<int, kMemoryAxes>& all = piece.memory.nodes;
  const auto [glass, hysteresis, decades] = box.nodes;
  piece.terms.resize(static_cast<std::size_t>(piece.coefficients.rows()), 0);
  for (int m = 0; m < box.size(); ++m) {
    const int to = m % glass + all[0] * (m / glass % hysteresis +
                                         all[1] * (m / glass / hysteresis));
    for (int k = 0; k < rates; ++k) {
      RateBlock sum = rate_block(values, m, 0, count) * in_rate_(0, k);
      for (int i = 1; i < rates; ++i)
        sum += rate_block(values, m, i, count) * in_rate_(i, k);
      const int first = kChannels * (k + rates * to);
      auto rows = piece.coefficients.block(first, 0, kChannels, count);
      if (is_first) {
        rows = sum * in_temperature;
      } else {
        rows += sum * in_temperature;
      }
      for (int c = 0; c < kChannels; ++c) {
        int& terms = piece.terms[static_cast<std::size_t>(first) +
                                 static_cast<std::size_t>(c)];
        terms = std::max(terms, count);
      }
    }
    if (to > 0 &&
        std::ranges::find(piece.memory_terms, to) == piece.memory_terms.end())
      piece.memory_terms.push_back(to);
  }
}

// At memory states that are `memory_share` as far from the middle as the
// corners of the box.
double StaticMap::error(const Piece& piece, double memory_share) {
  // Between the outer nodes and the ends and near the middle, where the error
  // of Chebyshev interpolation is largest.
  constexpr std::array<double, 5> kProbes = {-1, -0.93, 0.2, 0.75, 1};
  constexpr std::array<MemoryPoint, 5> kStates = {{{-1, -1, -0.9},
                                                   {0.95, 0.9, 0.9},
                                                   {-0.6, 1, 0.9},
                                                   {0.7, -0.9, -0.9},
                                                   {1, 1, -0.9}}};
  double largest = 0;
  for (std::size_t i = 0; i < kProbes.size(); ++i) {
    const double T = 0.5 * (piece.low + piece.high) +
                     0.5 * (piece.high - piece.low) * kProbes[i];
    MemoryPoint place = kStates[i];
    for (double& x : place) x *= memory_share;
    const MemoryState memory = piece.memory.state(place);
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
  if (bounds_ && ++fits_ > kMostFits) throw unresolved(low, high);
  std::optional<Piece> piece = fitted(low, high);
  // The rest of the tolerance is left for the points between the probes.
  const double allowed = 0.25 * tolerance_;
  const bool is_small = high - low < kSmallestPiece;
  bool good = piece && ((is_small && !bounds_) || error(*piece) <= allowed);
  if (piece && !good && bounds_ && (is_small || error(*piece, 0) <= allowed)) {
    // The states do more together.
    good = add_part(*piece, piece->memory.nodes, kTemperatureNodes, false);
    prune(*piece);
    good = good && error(*piece) <= (is_small ? tolerance_ : allowed);
  }
  if (good) {
    pieces_.push_back(std::move(*piece));
    return;
  }
  // Smaller pieces do not shorten the expansion in T_f - T_f,ref.
  if (bounds_ && is_small) throw unresolved(low, high);
  const double middle = 0.5 * (low + high);
  refine(low, middle);
  refine(middle, high);
}

}  // namespace beamgyro::internal
