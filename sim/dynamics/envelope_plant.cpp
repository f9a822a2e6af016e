// SPDX-License-Identifier: MIT
#include "sim/dynamics/envelope_plant.h"

#include <complex>

#include "linear_algebra/linear_systems.h"
#include "sim/dynamics/complex_form.h"

namespace beamgyro::internal {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;

}  // namespace

EnvelopePlant::EnvelopePlant(const Matrix2d& stiffness,
                             const Matrix2d& velocity, double omega)
    : omega_(omega), velocity_(velocity) {
  Matrix2cd P = velocity.cast<std::complex<double>>();
  P.diagonal().array() += 2.0 * kI * omega;
  r_ = inverse_of(P);
  s_.real() = stiffness;
  s_.imag() = omega * velocity;
  s_.diagonal().array() -= omega * omega;
  d_ = r_ * r_;
  b_ = r_ + d_ * s_ * r_;
  a_ = -b_ * s_;
}

EnvelopePlant::Slope EnvelopePlant::slope(const Matrix2cd& dP,
                                          const Matrix2cd& dS) const {
  const Matrix2cd dR = -r_ * dP * r_;
  Slope d;
  d.D = dR * r_ + r_ * dR;
  d.B = dR + d.D * s_ * r_ + d_ * dS * r_ + d_ * s_ * dR;
  d.A = -d.B * s_ - b_ * dS;
  return d;
}

EnvelopePlant::Slope EnvelopePlant::by_frequency() const {
  Matrix2cd dS = kI * velocity_.cast<std::complex<double>>();
  dS.diagonal().array() -= 2 * omega_;
  return slope(2.0 * kI * Matrix2cd::Identity(), dS);
}

EnvelopePlant::Slope EnvelopePlant::by(const Matrix2d& stiffness,
                                       const Matrix2d& velocity) const {
  const Matrix2cd dP = velocity.cast<std::complex<double>>();
  return slope(dP, stiffness.cast<std::complex<double>>() + kI * omega_ * dP);
}

}  // namespace beamgyro::internal
