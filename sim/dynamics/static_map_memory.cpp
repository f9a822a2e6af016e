// SPDX-License-Identifier: MIT
// The memory states in the table of a StaticMap.
#include <algorithm>
#include <array>
#include <cstddef>

#include "sim/dynamics/chebyshev.h"
#include "sim/dynamics/static_map.h"

namespace beamgyro::internal {

// The error a table may have in frequency [rad/s] and voltage [V], per rad/s of
// the signal's tolerance: 1e-6 deg/s go with 1e-6 Hz and 1e-7 V.
double StaticMap::weighted(const Eigen::Vector4d& error) {
  return Eigen::Vector4d(1, 1, 2.8e-3, 0.17)
      .cwiseProduct(error)
      .cwiseAbs()
      .maxCoeff();
}

MemoryState StaticMap::MemoryBox::state(const MemoryPoint& place) const {
  return {middle[0] + half[0] * place[0], middle[1] + half[1] * place[1],
          middle[2] + half[2] * place[2]};
}

MemoryState StaticMap::MemoryBox::node_state(int index) const {
  MemoryPoint place{};
  for (std::size_t axis = 0; axis < kMemoryAxes; ++axis) {
    place[axis] = chebyshev_node(index % nodes[axis], nodes[axis]);
    index /= nodes[axis];
  }
  return state(place);
}

// Turns values at the nodes, a column each, into coefficients.
Eigen::MatrixXd StaticMap::MemoryBox::transform() const {
  std::array<Eigen::MatrixXd, kMemoryAxes> along;
  for (std::size_t axis = 0; axis < kMemoryAxes; ++axis)
    along[axis] = chebyshev_transform(nodes[axis]);
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

// Adds what hysteresis and age do by themselves, and each pair of states.
bool StaticMap::add_memory(Piece& piece) {
  constexpr double kNarrow = 0.1;  // [K]
  constexpr int kLine = 2, kFew = 4, kSome = 7;
  const auto [glass, hysteresis, decades] = piece.memory.nodes;
  const int curve = std::min(glass, 3), line = std::min(glass, 2);
  const int slope = std::min(hysteresis, 2), ageing = std::min(decades, 2);
  struct Part {
    std::array<int, kMemoryAxes> nodes;
    int temperature_nodes;
    bool is_pair;
  };
  const std::array<Part, 5> parts = {{{{1, hysteresis, 1}, kSome, false},
                                      {{1, 1, decades}, kSome, false},
                                      {{curve, slope, 1}, kSome, true},
                                      {{line, 1, ageing}, kFew, true},
                                      {{1, slope, ageing}, kFew, true}}};
  for (const Part& part : parts) {
    const auto axes =
        std::ranges::count_if(part.nodes, [](int n) { return n > 1; });
    if (axes < (part.is_pair ? 2 : 1)) continue;
    const int along =
        piece.high - piece.low < kNarrow ? kLine : part.temperature_nodes;
    if (!add_part(piece, part.nodes, along, part.is_pair) &&
        !add_part(piece, part.nodes, kTemperatureNodes, false))
      return false;
  }
  return true;
}

// Memory changes the response by little: most of its rows need few terms, or
// none.
void StaticMap::prune(Piece& piece) const {
  const Eigen::Index rows = piece.coefficients.rows();
  const auto unused = std::ranges::count(piece.terms, 0);
  const double allowed =
      0.6 * tolerance_ * kChannels / static_cast<double>(rows - unused);
  for (Eigen::Index row = 0; row < rows; ++row) {
    int terms = piece.terms[static_cast<std::size_t>(row)];
    double dropped = 0;
    for (; terms > 0; --terms) {
      Eigen::Vector4d part = Eigen::Vector4d::Zero();
      part(row % kChannels) = piece.coefficients(row, terms - 1);
      dropped += weighted(part);
      if (dropped > allowed) break;
    }
    piece.terms[static_cast<std::size_t>(row)] = terms;
    piece.coefficients.row(row).tail(kTemperatureNodes - terms).setZero();
  }
  const auto rows_each = static_cast<std::size_t>(rows / piece.memory.size());
  std::erase_if(piece.memory_terms, [&](int m) {
    const auto first =
        piece.terms.begin() + static_cast<std::ptrdiff_t>(rows_each) * m;
    return std::all_of(first, first + static_cast<std::ptrdiff_t>(rows_each),
                       [](int terms) { return terms == 0; });
  });
}

}  // namespace beamgyro::internal
