// SPDX-License-Identifier: MIT
#include "compensation/models/polynomial.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

Eigen::MatrixXd terms(const Eigen::Ref<const ArrayXXd>& x, int degree) {
  Eigen::MatrixXd columns(x.rows(), degree + x.cols());
  columns.col(0).setOnes();
  for (int n = 1; n <= degree; ++n)
    columns.col(n) = columns.col(n - 1).array() * x.col(0);
  columns.rightCols(x.cols() - 1) = x.rightCols(x.cols() - 1).matrix();
  return columns;
}

[[noreturn]] void fail(int degree, Index rows, Index rank, Index needed) {
  throw std::invalid_argument(
      fmt::format("polynomial of degree {}: the {} rows determine only {} of "
                  "its {} coefficients",
                  degree, rows, rank, needed));
}

Polynomial polynomial_of(const Eigen::VectorXd& c, int degree) {
  return {{c.begin(), c.begin() + degree + 1},
          {c.begin() + degree + 1, c.end()}};
}

}  // namespace

ArrayXd Polynomial::predict(const Eigen::Ref<const ArrayXXd>& x) const {
  ArrayXd y = ArrayXd::Zero(x.rows());
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c)
    y = y * x.col(0) + *c;
  for (std::size_t j = 0; j < slopes.size(); ++j)
    y += slopes[j] * x.col(static_cast<Index>(j) + 1);
  return y;
}

Polynomial fit_polynomial(const Eigen::Ref<const ArrayXXd>& x,
                          const Eigen::Ref<const ArrayXd>& y, int degree) {
  const Eigen::MatrixXd columns = terms(x, degree);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  if (qr.rank() < columns.cols())
    fail(degree, x.rows(), qr.rank(), columns.cols());
  return polynomial_of(qr.solve(y.matrix()), degree);
}

Polynomial fit_polynomial_by_normal_equations(
    const Eigen::Ref<const ArrayXXd>& x, const Eigen::Ref<const ArrayXd>& y,
    int degree) {
  const Eigen::MatrixXd columns = terms(x, degree);
  const Eigen::LLT<Eigen::MatrixXd> normal(columns.transpose() * columns);
  if (normal.info() != Eigen::Success)
    throw std::invalid_argument(fmt::format(
        "polynomial of degree {}: the normal equations of {} rows cannot be "
        "solved in double precision; normalised = true needs none",
        degree, x.rows()));
  return polynomial_of(normal.solve(columns.transpose() * y.matrix()), degree);
}

std::vector<double> shifted(std::vector<double> coefficients, double origin) {
  // Repeated synthetic division.
  for (std::size_t n = 0; n < coefficients.size(); ++n)
    for (std::size_t k = coefficients.size() - 1; k-- > n;)
      coefficients[k] += origin * coefficients[k + 1];
  return coefficients;
}

}  // namespace beamgyro
