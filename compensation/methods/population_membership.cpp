// SPDX-License-Identifier: MIT
#include "compensation/methods/population_membership.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "compensation/methods/population_equations.h"
#include "linear_algebra/cholesky.h"
#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// (I + scale H H^T)^-1
MatrixXd inverse_covariance(const MatrixXd& H, double scale) {
  MatrixXd S = scale * H * H.transpose();
  S.diagonal().array() += 1.0;
  return Cholesky(S).inverse();
}

// Of each device of the population from all others, increasing.
std::vector<double> own_distances(const Population& population,
                                  const MatrixXd& H) {
  const auto [alpha, beta, gamma] = left_out_device(population);
  const MatrixXd B = inverse_covariance(H, alpha);
  std::vector<double> distances;
  // The curves that the devices were learned from have no further own parts.
  const auto learned = H.leftCols(population.modes.cols());
  std::uint32_t device = 0;
  for (const auto& c : population.coefficients.rowwise()) {
    // S^-1 = (B^-1 - beta g g^T)^-1 by Sherman and Morrison.
    const VectorXd g = learned * c.transpose(), Bg = B * g;
    VectorXd shown(g.size());
    RandomStream stream(0, device++, 0, kMembershipStream);
    stream.fill_normal(std::span<double>(
        shown.data(), static_cast<std::size_t>(shown.size())));
    shown += gamma * g;
    distances.push_back(shown.dot(B * shown) + beta *
                                                   std::pow(Bg.dot(shown), 2) /
                                                   (1.0 - beta * g.dot(Bg)));
  }
  std::ranges::sort(distances);
  return distances;
}

// By how much points change if their temperature is 1 K too low, each over its
// noise, for the device that they show.
VectorXd slopes(const Population& population, const std::vector<Input>& inputs,
                const TrainingRows& rows, const PointNoise& noise,
                const PointEquations& points) {
  const auto shifted = [&](double by) {
    TrainingRows moved = rows;
    moved.temperature += by;
    return point_equations(population, inputs, moved, noise);
  };
  const PointEquations below = shifted(-0.5), above = shifted(0.5);
  const VectorXd c =
      points.H.transpose() * inverse_covariance(points.H, 1.0) * points.y;
  return below.y - above.y + (above.H - below.H) * c;
}

}  // namespace

std::optional<Membership> membership(const Population& population,
                                     const std::vector<Input>& inputs,
                                     const TrainingRows& rows,
                                     const PointNoise& noise) {
  const Index devices = population.coefficients.rows();
  const auto rank = static_cast<Index>(
      std::ceil(kOwnShare * static_cast<double>(devices + 1)));
  if (rows.size() == 0 || rank > devices) return {};
  PointEquations points = point_equations(population, inputs, rows, noise);
  const VectorXd slope = slopes(population, inputs, rows, noise, points);
  points.H.conservativeResize(Eigen::NoChange, points.H.cols() + 1);
  points.H.rightCols(1) = kBeamTemperatureError * slope;
  const double distance =
      points.y.dot(inverse_covariance(points.H, 1.0) * points.y);
  return Membership{
      distance, points.y.size(),
      own_distances(population, points.H)[static_cast<std::size_t>(rank - 1)],
      devices};
}

}  // namespace beamgyro::internal
