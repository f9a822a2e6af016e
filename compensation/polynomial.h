// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamgyro {

/// p(x) = c_0 + c_1 x + ... + c_n x^n, x scaled to [-1, 1].
struct Polynomial {
  std::vector<double> coefficients;  // c_0 ... c_n

  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXd>& x) const;
};

/// Least squares by Householder QR. Throws std::invalid_argument when `x` does
/// not determine a polynomial of that degree.
Polynomial fit_polynomial(const Eigen::Ref<const Eigen::ArrayXd>& x,
                          const Eigen::Ref<const Eigen::ArrayXd>& y,
                          int degree);

}  // namespace beamgyro
