// SPDX-License-Identifier: MIT
#include "sensitivity/indices/rank_index.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace beamgyro::internal {
namespace {

constexpr std::size_t kMostNeighbours = 8192;
constexpr Eigen::Index kLeastRows = 32;  // of an interval
// Of a degree of freedom: a ratio of moments of few rows is skew.
constexpr double kRowsOfFreedom = 8;
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

}  // namespace

RankIndex rank_index(const std::vector<double>& values,
                     const Eigen::MatrixXd& numbers) {
  std::vector<std::size_t> rows;
  double mean = 0;
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (!std::isfinite(values[j])) continue;
    rows.push_back(j);
    mean += values[j];
  }
  if (rows.size() < 2) return {};
  mean /= static_cast<double>(rows.size());
  const bool is_ordered = numbers.cols() == 1;
  const std::vector<RowPair> pairs = is_ordered
                                         ? pairs_by_rank(rows, numbers)
                                         : pairs_by_distance(rows, numbers);
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::ArrayXd f(n), next(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [row, neighbour] = pairs[static_cast<std::size_t>(k)];
    f(k) = values[row] - mean;
    next(k) = values[neighbour] - mean;
  }
  const double variance = f.square().mean() - f.mean() * f.mean();
  if (variance <= kSameValue * mean * mean) return {0, Interval{0, 0}};
  const double index = ((f * next).mean() - f.mean() * f.mean()) / variance;
  if (!is_ordered || n < kLeastRows) return {index, {}};

  // Each row is in two pairs, so pairs that follow each other are correlated.
  const Eigen::ArrayXd parts =
      (f * next - 0.5 * index * (f.square() + next.square())) / variance;
  const double alone = parts.square().sum();
  const double together =
      (parts.head(n - 1) * parts.tail(n - 1)).sum() + parts(n - 1) * parts(0);
  const auto count = static_cast<double>(n);
  const double sigma =
      std::max(std::sqrt(std::max(alone, alone + 2 * together)) / count,
               (1 - index * index) / std::sqrt(count));
  const double half = student_half_width(count / kRowsOfFreedom) * sigma;
  return {index, Interval{index - half, index + half}};
}

}  // namespace beamgyro::internal
