// SPDX-License-Identifier: MIT
#include "compensation/methods/bump_shares.h"

#include <cmath>

#include "linear_algebra/cholesky.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUnsure = 0.03;  // of a soak's bias, of the spread of all
constexpr double kNoBump = 0.2;   // probability that a bump has no bias
constexpr Index kSizes = 8;       // of the smooth rest

// Sign of each resonance, -1, 0 or 1: number `code` in base 3.
VectorXd signs_of(Index code, Index count) {
  VectorXd signs(count);
  for (Index k = 0; k < count; ++k) {
    signs(k) = static_cast<double>(code % 3 - 1);
    code /= 3;
  }
  return signs;
}

// Log of the evidence of signs when the rest has one size.
class SignEvidence {
 public:
  SignEvidence(const VectorXd& t, const VectorXd& bias, const MatrixXd& bumps,
               double spread, double size, double noise) {
    const Index n = t.size();
    MatrixXd V = MatrixXd::Constant(n, n, 1e4 * spread * spread);
    for (int power = 1; power <= 3; ++power) {
      const ArrayXd shape = (power * t.array().max(-1.0).min(1.0).acos()).cos();
      const double sigma = size / (power * power);
      V += sigma * sigma * (shape.matrix() * shape.matrix().transpose());
    }
    V.diagonal().array() += kUnsure * kUnsure * spread * spread + noise * noise;
    const Cholesky factor(V);
    constant_ = -0.5 * bias.dot(factor.solve(bias)) -
                factor.lower().diagonal().array().log().sum();
    linear_ = bumps.transpose() * factor.solve(bias);
    quadratic_ = bumps.transpose() * factor.solve(bumps);
  }

  double of(const VectorXd& signs) const {
    const double none = signs.array().abs().sum();
    return constant_ + signs.dot(linear_) -
           0.5 * signs.dot(quadratic_ * signs) +
           none * std::log((1.0 - kNoBump) / 2.0) +
           (static_cast<double>(signs.size()) - none) * std::log(kNoBump);
  }

 private:
  double constant_ = 0.0;
  VectorXd linear_;
  MatrixXd quadratic_;
};

}  // namespace

VectorXd bump_shares(const VectorXd& t, const VectorXd& bias,
                     const MatrixXd& bumps, double noise) {
  const Index count = bumps.cols();
  const double spread = std::sqrt((bias.array() - bias.mean()).square().mean());
  if (count == 0 || spread == 0.0) return VectorXd::Zero(count);
  Index codes = 1;
  for (Index k = 0; k < count; ++k) codes *= 3;
  const VectorXd level = (bias.array() - bias.mean()).matrix();
  MatrixXd logs(codes, kSizes);
  for (Index size = 0; size < kSizes; ++size) {
    const SignEvidence evidence(
        t, level, bumps, spread,
        spread * 0.03 *
            std::pow(10.0 / 0.03, static_cast<double>(size) / (kSizes - 1)),
        noise);
    for (Index code = 0; code < codes; ++code)
      logs(code, size) = evidence.of(signs_of(code, count));
  }
  const VectorXd weights =
      (logs.array() - logs.maxCoeff()).exp().rowwise().sum().matrix();
  VectorXd mean = VectorXd::Zero(count);
  for (Index code = 0; code < codes; ++code)
    mean += weights(code) * signs_of(code, count);
  return mean / weights.sum();
}

}  // namespace beamgyro::internal
