// SPDX-License-Identifier: MIT
#include "sensitivity/indices/rank_index.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kBlockOfPairs = 16, kMostNeighbours = 8192;
constexpr double kSameValue = 1e-20;  // [-], variance over the mean's square

using RowPair = std::pair<std::size_t, std::size_t>;

// In the order of the numbers.
std::vector<RowPair> pairs_by_rank(std::vector<std::size_t> rows,
                                   const Eigen::MatrixXd& numbers) {
  const auto number = [&](std::size_t row) {
    return numbers(static_cast<Eigen::Index>(row), 0);
  };
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(number(a), a) < std::pair(number(b), b);
  });
  std::vector<RowPair> pairs;
  for (std::size_t k = 0; k < rows.size(); ++k)
    pairs.emplace_back(rows[k], rows[(k + 1) % rows.size()]);
  return pairs;
}

std::vector<RowPair> pairs_by_distance(std::vector<std::size_t> rows,
                                       const Eigen::MatrixXd& numbers) {
  rows.resize(std::min(rows.size(), kMostNeighbours));
  Eigen::MatrixXd points(numbers.cols(),
                         static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    points.col(k) = numbers.row(
        static_cast<Eigen::Index>(rows[static_cast<std::size_t>(k)]));
  std::vector<RowPair> pairs;
  Eigen::RowVectorXd squares(points.cols());
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    squares = (points.colwise() - points.col(k)).colwise().squaredNorm();
    squares(k) = std::numeric_limits<double>::infinity();
    Eigen::Index nearest = 0;
    squares.minCoeff(&nearest);
    pairs.emplace_back(rows[static_cast<std::size_t>(k)],
                       rows[static_cast<std::size_t>(nearest)]);
  }
  return pairs;
}

// Sums over a block of pairs.
struct PairSums {
  double count = 0, value = 0, square = 0, product = 0;

  void add(double f, double neighbour) {
    count += 1;
    value += f;
    square += f * f;
    product += f * neighbour;
  }
  void add(const PairSums& other) {
    count += other.count;
    value += other.value;
    square += other.square;
    product += other.product;
  }
  double index() const {
    const double mean = value / count;
    const double variance = square / count - mean * mean;
    return (product / count - mean * mean) / variance;
  }
};

}  // namespace

IndexEstimate rank_index(const std::vector<double>& values,
                         const Eigen::MatrixXd& numbers, std::uint64_t seed,
                         std::uint32_t stream) {
  std::vector<std::size_t> rows;
  double mean = 0;
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (!std::isfinite(values[j])) continue;
    rows.push_back(j);
    mean += values[j];
  }
  if (rows.size() < 2) return {};
  mean /= static_cast<double>(rows.size());
  const std::vector<RowPair> pairs = numbers.cols() == 1
                                         ? pairs_by_rank(rows, numbers)
                                         : pairs_by_distance(rows, numbers);
  std::vector<PairSums> blocks((pairs.size() + kBlockOfPairs - 1) /
                               kBlockOfPairs);
  PairSums all;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [row, next] = pairs[k];
    blocks[k / kBlockOfPairs].add(values[row] - mean, values[next] - mean);
  }
  for (const PairSums& block : blocks) all.add(block);
  if (all.square / all.count <= kSameValue * mean * mean) return {};
  std::vector<double> replicates;
  for (std::uint32_t k = 0; k < kResamples; ++k) {
    RandomStream random(seed, k, stream, kRankResampleStream);
    PairSums drawn;
    for (std::size_t n = 0; n < blocks.size(); ++n)
      drawn.add(blocks[static_cast<std::size_t>(
          random.uniform() * static_cast<double>(blocks.size()))]);
    replicates.push_back(drawn.index());
  }
  return with_interval(all.index(), std::move(replicates));
}

}  // namespace beamgyro::internal
