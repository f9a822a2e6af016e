// SPDX-License-Identifier: MIT
#include "compensation/methods/lines_and_bumps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "linear_algebra/cholesky.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFirstNoise = 1e-2;  // of a row, of the bias's sigma
constexpr double kLeastNoise = 1e-4;
constexpr double kDamping = 1e-14;  // of all factors, of the trace

ArrayXd even_knots(const ArrayXd& t, double spacing) {
  const double low = t.minCoeff(), high = t.maxCoeff();
  if (!(high > low)) return ArrayXd::Constant(1, low);
  return ArrayXd::LinSpaced(
      1 + static_cast<Index>(std::ceil((high - low) / spacing)), low, high);
}

// Shares of both knots beside each t.
MatrixXd columns_of_lines(const ArrayXd& t, const ArrayXd& knots) {
  MatrixXd columns = MatrixXd::Zero(t.size(), knots.size());
  const Index pieces = knots.size() - 1;
  if (pieces == 0) {
    columns.setOnes();
    return columns;
  }
  const double step = (knots(pieces) - knots(0)) / static_cast<double>(pieces);
  for (Index row = 0; row < t.size(); ++row) {
    const double at = (t(row) - knots(0)) / step;
    const Index left = std::clamp<Index>(static_cast<Index>(at), 0, pieces - 1);
    columns(row, left + 1) = at - static_cast<double>(left);
    columns(row, left) = 1.0 - columns(row, left + 1);
  }
  return columns;
}

// Sum of the squares of second differences, as a matrix.
MatrixXd squares_of_kinks(Index knots, Index columns) {
  MatrixXd squares = MatrixXd::Zero(columns, columns);
  const Eigen::Vector3d kink(1.0, -2.0, 1.0);
  for (Index k = 0; k + 2 < knots; ++k)
    squares.block<3, 3>(k, k) += kink * kink.transpose();
  return squares;
}

}  // namespace

LinesAndBumps fit_lines_and_bumps(const ArrayXd& t, const ArrayXd& bias,
                                  const MatrixXd& bumps, double spacing) {
  if (t.size() == 0 || !(spacing > 0.0))
    throw std::invalid_argument(
        fmt::format("lines and bumps: {} rows and knots {} apart, must be 1 or "
                    "more and above 0",
                    t.size(), spacing));
  const ArrayXd knots = even_knots(t, spacing);
  const double mean = bias.mean();
  const VectorXd b = (bias - mean).matrix();
  const double spread = b.squaredNorm() / static_cast<double>(b.size());
  if (!(spread > 0.0))
    return {{knots, ArrayXd::Constant(knots.size(), mean)},
            VectorXd::Zero(bumps.cols())};
  MatrixXd A(t.size(), knots.size() + bumps.cols());
  A << columns_of_lines(t, knots), bumps;
  const MatrixXd squares = A.transpose() * A;
  const VectorXd moments = A.transpose() * b;
  const MatrixXd kinks = squares_of_kinks(knots.size(), A.cols());
  double variance = kFirstNoise * kFirstNoise * spread, left = 0.0;
  VectorXd factors;
  for (int pass = 0; pass < 2; ++pass) {
    MatrixXd normal = squares + variance / spread * kinks;
    normal.diagonal().tail(bumps.cols()).array() += variance;
    normal.diagonal().array() += kDamping * squares.trace();
    factors = Cholesky(normal).solve(moments);
    left = (b - A * factors).squaredNorm() / static_cast<double>(b.size());
    variance = std::max(left, kLeastNoise * kLeastNoise * spread);
  }
  return {{knots, factors.head(knots.size()).array() + mean},
          factors.tail(bumps.cols()),
          std::sqrt(left)};
}

}  // namespace beamgyro::internal
