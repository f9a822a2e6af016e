// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamgyro::internal {

inline constexpr std::complex<double> kI(0, 1);

/// Returns y_i + i y_{i+1} as a complex number.
inline std::complex<double> complex_at(
    const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index i) {
  return {y(i), y(i + 1)};
}

/// Writes real and imaginary part of `value` to the elements i and i + 1 of
/// `y`.
template <class Vector>
void put(Vector& y, Eigen::Index i, std::complex<double> value) {
  y(i) = value.real();
  y(i + 1) = value.imag();
}

/// Returns the charge of an electrode pair, the unconjugated product Theta^T u.
inline std::complex<double> charge_of(const Eigen::Vector2cd& coupling,
                                      const Eigen::Vector2cd& u) {
  return coupling.transpose() * u;
}

/// Returns a complex 2 x 2 matrix as a real 4 x 4 one, with the block [[a, -b],
/// [b, a]] for each element a + i b.
inline Eigen::Matrix4d real_form(const Eigen::Matrix2cd& matrix) {
  Eigen::Matrix4d real;
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (Eigen::Index j = 0; j < 2; ++j) {
      const std::complex<double> z = matrix(i, j);
      real.block<2, 2>(2 * i, 2 * j) << z.real(), -z.imag(), z.imag(), z.real();
    }
  }
  return real;
}

}  // namespace beamgyro::internal
