// SPDX-License-Identifier: MIT
#include "sim/numerics/symmetric_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kHalf = SymmetricBand::kHalf;
constexpr std::size_t kWidth = 2 * kHalf + 1;  // of a row, filled in
using Row = std::array<double, kWidth>;

// Rows as elimination meets them: each begins at the first column that it can
// have an entry in when its turn to be eliminated comes.
std::vector<Row> rows_of(const SymmetricBand& A) {
  const Index n = A.size();
  std::vector<Row> rows(static_cast<std::size_t>(n), Row{});
  for (Index i = 0; i < n; ++i) {
    const Index first = std::max(Index{0}, i - kHalf);
    for (Index j = first; j <= std::min(n - 1, i + kHalf); ++j) {
      rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j - first)] =
          A.diagonals(std::min(i, j), std::abs(i - j));
    }
  }
  return rows;
}

}  // namespace

VectorXd SymmetricBand::operator*(const VectorXd& x) const {
  const Index n = size();
  VectorXd product = diagonals.col(0).cwiseProduct(x);
  for (Index d = 1; d <= std::min(kHalf, n - 1); ++d) {
    const auto diagonal = diagonals.col(d).head(n - d);
    product.tail(n - d) += diagonal.cwiseProduct(x.head(n - d));
    product.head(n - d) += diagonal.cwiseProduct(x.tail(n - d));
  }
  return product;
}

Eigen::MatrixXd SymmetricBand::dense() const {
  const Index n = size();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (Index d = 0; d <= std::min(kHalf, n - 1); ++d) {
    A.diagonal(d) = diagonals.col(d).head(n - d);
    A.diagonal(-d) = diagonals.col(d).head(n - d);
  }
  return A;
}

std::optional<VectorXd> solved(const SymmetricBand& A, VectorXd b) {
  std::vector<Row> rows = rows_of(A);
  const std::size_t n = rows.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t end = std::min(n, k + 1 + kHalf);
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < end; ++i) {
      if (std::abs(rows[i][0]) > std::abs(rows[pivot][0])) pivot = i;
    }
    if (rows[pivot][0] == 0) return {};
    std::swap(rows[k], rows[pivot]);
    std::swap(b.data()[k], b.data()[pivot]);
    for (std::size_t i = k + 1; i < end; ++i) {
      const double factor = rows[i][0] / rows[k][0];
      for (std::size_t c = 1; c < kWidth; ++c)
        rows[i][c - 1] = rows[i][c] - factor * rows[k][c];
      rows[i][kWidth - 1] = 0;
      b.data()[i] -= factor * b.data()[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    double sum = b.data()[k];
    for (std::size_t c = 1; c < std::min(kWidth, n - k); ++c)
      sum -= rows[k][c] * b.data()[k + c];
    b.data()[k] = sum / rows[k][0];
  }
  return b;
}

}  // namespace beamgyro::internal
