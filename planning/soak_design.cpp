// SPDX-License-Identifier: MIT
#include "planning/soak_design.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "linear_algebra/cholesky.h"
#include "planning/chamber.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// [-], of the mean variance: smaller gains are rounding.
constexpr double kLeastGain = 1e-9;
constexpr double kWaySlack = 1e-9;  // [K], rounding of a way

}  // namespace

// With c = L z and z ~ N(0, I) everything is as of z, with H L and L^T W L.
SoakDesign::SoakDesign(const SoakModel& model, DesignLimits limits,
                       const MatrixXd& root)
    : model_(model),
      limits_(std::move(limits)),
      root_(root),
      weight_(root.size() > 0
                  ? MatrixXd(root.transpose() * model.weight() * root)
                  : model.weight()),
      equations_(equations(limits_.candidates)) {}

MatrixXd SoakDesign::equations(const std::vector<double>& soaks) const {
  const MatrixXd H = model_.equations(soaks);
  return root_.size() > 0 ? MatrixXd(H * root_) : H;
}

MatrixXd SoakDesign::covariance(const std::vector<double>& soaks) const {
  const MatrixXd H = equations(with_start_row(soaks, limits_.start_row));
  MatrixXd A = H.transpose() * H;
  A.diagonal().array() += 1.0;
  return Cholesky(A).inverse();
}

double SoakDesign::mean_variance(const std::vector<double>& soaks) const {
  return weight_.cwiseProduct(covariance(soaks)).sum();
}

bool SoakDesign::is_allowed(const std::vector<double>& soaks) const {
  const auto& row = limits_.start_row;
  if (row && !has_start_row(soaks, limits_.start, *row)) return false;
  const std::vector<double> shown = with_start_row(soaks, row);
  for (std::size_t i = 0; i < shown.size(); ++i)
    for (std::size_t j = i + 1; j < shown.size(); ++j)
      if (std::abs(shown[i] - shown[j]) < kLeastDistance) return false;
  return shortest_way(soaks, limits_.start) <= limits_.longest_way + kWaySlack;
}

// By how much each candidate lowers the mean variance.
std::vector<double> SoakDesign::reductions(const MatrixXd& P) const {
  const Index rows = model_.rows_per_soak();
  const MatrixXd U = P * equations_.transpose();  // a column per row of H
  const MatrixXd WU = weight_ * U;
  std::vector<double> found;
  for (Index k = 0; k < U.cols(); k += rows) {
    MatrixXd S = equations_.middleRows(k, rows) * U.middleCols(k, rows);
    S.diagonal().array() += 1.0;
    const MatrixXd V =
        U.middleCols(k, rows).transpose() * WU.middleCols(k, rows);
    found.push_back(Cholesky(S).solve(V).trace());
  }
  return found;
}

SoakDesign::Choice SoakDesign::best_addition(
    const std::vector<double>& soaks) const {
  const MatrixXd P = covariance(soaks);
  const std::vector<double> gains = reductions(P);
  Choice best{gains.size(), HUGE_VAL};
  double gain = -HUGE_VAL;
  std::vector<double> tried = soaks;
  tried.push_back(0.0);
  for (std::size_t k = 0; k < gains.size(); ++k) {
    tried.back() = limits_.candidates[k];
    if (gains[k] > gain && is_allowed(tried)) {
      gain = gains[k];
      best.candidate = k;
    }
  }
  if (best.candidate < gains.size())
    best.mean_variance = weight_.cwiseProduct(P).sum() - gain;
  return best;
}

std::vector<double> SoakDesign::extended(std::vector<double> soaks,
                                         std::size_t count) const {
  while (soaks.size() < count) {
    const Choice best = best_addition(soaks);
    if (best.candidate == limits_.candidates.size()) break;
    soaks.push_back(limits_.candidates[best.candidate]);
  }
  return soaks;
}

std::vector<double> SoakDesign::exchanged(std::vector<double> soaks) const {
  double least = mean_variance(soaks);
  for (bool improved = true; improved;) {
    improved = false;
    for (double& soak : soaks) {
      std::vector<double> others;
      for (const double& other : soaks)
        if (&other != &soak) others.push_back(other);
      const Choice best = best_addition(others);
      if (best.mean_variance < least * (1.0 - kLeastGain)) {
        soak = limits_.candidates[best.candidate];
        least = best.mean_variance;
        improved = true;
      }
    }
  }
  return soaks;
}

}  // namespace beamgyro::internal
