// SPDX-License-Identifier: MIT
#include "compensation/methods/population_own.h"

#include <cmath>
#include <limits>
#include <utility>

#include "linear_algebra/cholesky.h"
#include "linear_algebra/eigenvalues.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kOwnPartSoaks[] = {3, 5, 7};
constexpr double kLengths[] = {5.0, 10.0, 20.0, 40.0};  // [K]
// Of the spread of a curve over devices.
constexpr double kDeviations[] = {0.0,  0.003, 0.006, 0.012, 0.025,
                                  0.05, 0.1,   0.2,   0.4};
constexpr int kPasses = 2;  // through the curves
// [-], of the score: a smaller gain does not show.
constexpr double kLeastGain = 0.01;

// Matern's covariance of 3/2 and unit variance on a grid.
MatrixXd matern(const ArrayXd& T, double length) {
  MatrixXd K(T.size(), T.size());
  for (Index k = 0; k < T.size(); ++k) {
    const ArrayXd x = std::sqrt(3.0) / length * (T - T(k)).abs();
    K.col(k) = ((1.0 + x) * (-x).exp()).matrix();
  }
  return K;
}

MatrixXd root_of(const MatrixXd& covariance) {
  const auto [values, vectors] = symmetric_eigen(covariance);
  return vectors * values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

// Bias and channels that soaks at `count` temperatures of the grid show, as
// numbers of the stacked values.
std::vector<Index> shown_values(const Population& p, int count) {
  std::vector<Index> shown;
  const Index grid = p.grid();
  for (Index curve = 0; curve * grid < p.mean.size(); ++curve)
    for (int k = 0; k < count; ++k)
      shown.push_back(curve * grid +
                      std::lround(k * double(grid - 1) / (count - 1)));
  return shown;
}

// Predicts devices of a population from all others.
class LeaveOut {
 public:
  explicit LeaveOut(const Population& p)
      : p_(p),
        curves_(p.modes * p.coefficients.transpose()),
        others_(left_out_device(p)),
        covariance_(others_.alpha * p.modes * p.modes.transpose()) {
    for (Index k = 0; k < p.mean.size() / p.grid(); ++k) {
      const double noise = point_noise_of(p, k, PointNoise{p.point_noise});
      noise_.push_back(noise * noise);
    }
  }

  // Mean logarithm of the density, without a constant.
  double score(const std::vector<OwnPart>& own) const {
    MatrixXd C = covariance_;
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (own[k].deviation == 0.0) continue;
      const Index first = static_cast<Index>(k) * p_.grid();
      C.block(first, first, p_.grid(), p_.grid()) +=
          own[k].deviation * own[k].deviation *
          matern(p_.temperatures, own[k].length_K);
    }
    double sum = 0.0;
    for (const int count : kOwnPartSoaks)
      sum += score(C, shown_values(p_, count));
    return sum / std::size(kOwnPartSoaks);
  }

 private:
  double score(const MatrixXd& C, const std::vector<Index>& shown) const {
    const Index grid = p_.grid();
    MatrixXd S = C(shown, shown);
    for (std::size_t k = 0; k < shown.size(); ++k)
      S(static_cast<Index>(k), static_cast<Index>(k)) +=
          noise_[static_cast<std::size_t>(shown[k] / grid)];
    const MatrixXd B = Cholesky(S).inverse();
    const MatrixXd K = C(Eigen::seqN(0, grid), shown);
    const MatrixXd KB = K * B;
    // Of the posterior with all devices.
    const ArrayXd variance = C.diagonal().head(grid).array() -
                             KB.cwiseProduct(K).rowwise().sum().array();
    const auto [alpha, beta, gamma] = others_;
    double sum = 0.0;
    for (const auto& curve : curves_.colwise()) {
      // Without the device: C - beta b b^T, by Sherman and Morrison.
      const VectorXd g = curve(shown);
      const ArrayXd b = curve.head(grid).array();
      const double q = g.dot(B * g), left = 1.0 - beta * q;
      const ArrayXd predicted = (KB * g).array();
      const ArrayXd error = gamma * (b - predicted) / left;
      const ArrayXd own =
          variance - beta * (b - predicted).square() / left + noise_.front();
      sum -= 0.5 * (own.log() + error.square() / own).mean();
    }
    return sum / static_cast<double>(curves_.cols());
  }

  const Population& p_;
  MatrixXd curves_;  // deviations from the mean, a column for each device
  LeftOutDevice others_;
  MatrixXd covariance_;
  std::vector<double> noise_;  // variance of a point of each curve
};

}  // namespace

MatrixXd all_modes(const Population& p) {
  const Index grid = p.grid();
  MatrixXd modes = p.modes;
  for (std::size_t k = 0; k < p.own.size(); ++k) {
    const auto& [deviation, length] = p.own[k];
    if (deviation == 0.0) continue;
    const Index before = modes.cols();
    modes.conservativeResize(Eigen::NoChange, before + grid);
    modes.rightCols(grid).setZero();
    modes.block(static_cast<Index>(k) * grid, before, grid, grid) =
        deviation * root_of(matern(p.temperatures, length));
  }
  return modes;
}

std::vector<OwnPart> learned_own_parts(const Population& population) {
  if (population.devices < kLeastForOwnParts || population.modes.cols() == 0 ||
      population.coefficients.rows() == 0)
    return {};
  const LeaveOut devices(population);
  const auto curves =
      static_cast<std::size_t>(population.mean.size() / population.grid());
  double best = devices.score({}) + kLeastGain;
  std::vector<OwnPart> chosen;
  for (const double length : kLengths) {
    std::vector<OwnPart> own(curves, OwnPart{0.0, length});
    double own_best = -std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < kPasses; ++pass)
      for (std::size_t k = 0; k < curves; ++k) {
        const double spread = curve_spread(population, static_cast<Index>(k));
        OwnPart kept = own[k];
        for (const double share : kDeviations) {
          own[k].deviation = share * spread;
          const double score = devices.score(own);
          if (score <= own_best) continue;
          own_best = score;
          kept = own[k];
        }
        own[k] = kept;
      }
    if (own_best <= best) continue;
    best = own_best;
    chosen = own;
  }
  return chosen;
}

}  // namespace beamgyro::internal
