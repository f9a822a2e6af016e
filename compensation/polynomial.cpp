// SPDX-License-Identifier: MIT
#include "compensation/polynomial.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <stdexcept>

namespace beamgyro {

Eigen::ArrayXd Polynomial::predict(
    const Eigen::Ref<const Eigen::ArrayXd>& x) const {
  Eigen::ArrayXd y = Eigen::ArrayXd::Zero(x.size());
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c)
    y = y * x + *c;
  return y;
}

Polynomial fit_polynomial(const Eigen::Ref<const Eigen::ArrayXd>& x,
                          const Eigen::Ref<const Eigen::ArrayXd>& y,
                          int degree) {
  Eigen::MatrixXd powers(x.size(), degree + 1);
  powers.col(0).setOnes();
  for (int n = 1; n <= degree; ++n)
    powers.col(n) = powers.col(n - 1).array() * x;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(powers);
  if (qr.rank() < degree + 1)
    throw std::invalid_argument(
        fmt::format("polynomial of degree {}: the {} rows determine only {} of "
                    "its {} coefficients",
                    degree, x.size(), qr.rank(), degree + 1));
  const Eigen::VectorXd c = qr.solve(y.matrix());
  return {{c.begin(), c.end()}};
}

}  // namespace beamgyro
