// SPDX-License-Identifier: MIT
#include "sim/signal/linear_noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "linear_algebra/eigenvalues.h"
#include "linear_algebra/least_squares.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kShort = 0.25;    // |A| h of the first step
constexpr int kTaylorDegree = 12;  // kShort^13 / 13! = 2e-18
constexpr Index kDrawnAhead = 64;

void require_finite_model(const MatrixXd& matrix, const char* name) {
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = 0; i < matrix.rows(); ++i)
      if (!std::isfinite(matrix(i, j)))
        throw std::invalid_argument(
            fmt::format("noise system: {}({}, {}) is {}, must be finite", name,
                        i, j, matrix(i, j)));
}

void check(const NoiseSystem& system) {
  const MatrixXd& A = system.A;
  const MatrixXd& B = system.B;
  if (A.rows() == 0 || A.rows() != A.cols())
    throw std::invalid_argument(
        fmt::format("noise system: A is {} x {}, must be square and not empty",
                    A.rows(), A.cols()));
  if (B.rows() != A.rows() || B.cols() == 0)
    throw std::invalid_argument(
        fmt::format("noise system: B is {} x {}, must have {} rows as A, and a "
                    "column for every noise",
                    B.rows(), B.cols(), A.rows()));
  require_finite_model(A, "A");
  require_finite_model(B, "B");
}

// The system in units that make rows and columns of A alike, all sums of
// magnitudes with the diagonal: with it, a chain of filters is not scaled away.
// Powers of two, so that nothing is rounded (Parlett and Reinsch).
struct Balanced {
  MatrixXd A, B;
  VectorXd unit;  // old z = unit times new z
};

Balanced balanced(const NoiseSystem& system) {
  constexpr int kMaxSweeps = 100;
  constexpr double kGain = 0.95;
  Balanced b{system.A, system.B, VectorXd::Ones(system.A.rows())};
  bool changed = true;
  for (int sweep = 0; changed && sweep < kMaxSweeps; ++sweep) {
    changed = false;
    for (Index i = 0; i < b.A.rows(); ++i) {
      const double column = b.A.col(i).lpNorm<1>();
      const double row = b.A.row(i).lpNorm<1>();
      if (column == 0.0 || row == 0.0) continue;
      const double unit = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (column * unit + row / unit >= kGain * (column + row)) continue;
      b.A.col(i) *= unit;
      b.A.row(i) /= unit;
      b.B.row(i) /= unit;
      b.unit(i) *= unit;
      changed = true;
    }
  }
  return b;
}

// Lower triangular L with L L^T = W W^T: the orthogonal steps err relative to
// each row of W by itself, and no square is ever formed.
MatrixXd lower_root(const MatrixXd& W) {
  const Index n = W.rows(), rank = std::min(n, W.cols());
  MatrixXd L = MatrixXd::Zero(n, n);
  L.leftCols(rank) = upper_factor(W.transpose()).transpose();
  for (Index k = 0; k < rank; ++k)
    if (L(k, k) < 0.0) L.col(k) = -L.col(k);
  return L;
}

// growth = e^{A h} - 1 and L of a step h.
struct Step {
  MatrixXd growth, root;

  void make_twice_as_long() {
    const Index n = growth.rows();
    MatrixXd W(n, 2 * n);
    W.leftCols(n) = root;
    W.leftCols(n).noalias() += growth * root;
    W.rightCols(n) = root;
    root = lower_root(W);
    const MatrixXd square = growth * growth;
    growth = 2.0 * growth + square;
  }

  // Finite, and so are the squares of its elements.
  bool in_range() const {
    return std::isfinite(growth.squaredNorm()) &&
           std::isfinite(root.squaredNorm());
  }
};

// With e^{A h s} B = sum_j s^j V_j and orthonormal Legendre polynomials p_k on
// (0, 1), int p_k s^j ds = sqrt(2k+1) j!^2 / ((j-k)! (j+k+1)!) =: c_jk:
//   Q_h = h sum_k S_k S_k^T,  S_k = sum_j c_jk V_j.
Step short_step(const MatrixXd& A, const MatrixXd& B, double h) {
  const Index n = A.rows(), m = B.cols();
  Step step;
  MatrixXd power = A * h, V = B * std::sqrt(h);
  step.growth = power;
  MatrixXd W = MatrixXd::Zero(n, m * (kTaylorDegree + 1));
  for (int j = 0; j <= kTaylorDegree; ++j) {
    if (j > 0) V = MatrixXd(A * V) * (h / j);
    if (j > 1) {
      power = MatrixXd(A * power) * (h / j);
      step.growth += power;
    }
    double share = 1.0 / (j + 1);  // j!^2 / ((j-k)! (j+k+1)!)
    for (int k = 0; k <= j; ++k) {
      W.middleCols(k * m, m) += std::sqrt(2.0 * k + 1.0) * share * V;
      share *= static_cast<double>(j - k) / (j + k + 2);
    }
  }
  step.root = lower_root(W);
  return step;
}

double norm(const MatrixXd& A) {
  return A.cwiseAbs().colwise().sum().maxCoeff();
}

template <class Dense>
std::span<double> values_of(Dense& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

// Root in the units of the caller; a triangle stays one.
MatrixXd in_units(const MatrixXd& root, const VectorXd& unit) {
  return unit.asDiagonal() * root;
}

}  // namespace

SampledNoise sampled_noise(const NoiseSystem& system, double interval) {
  check(system);
  if (!(interval > 0.0) || !std::isfinite(interval))
    throw std::invalid_argument(
        fmt::format("sampling interval is {} s, must be above 0", interval));
  const Balanced b = balanced(system);
  const double length = norm(b.A) * interval;
  if (!std::isfinite(length))
    throw std::invalid_argument(
        fmt::format("noise system: A times the sampling interval of {} s is "
                    "not finite",
                    interval));
  const int doublings =
      length > kShort ? static_cast<int>(std::ceil(std::log2(length / kShort)))
                      : 0;
  Step step = short_step(b.A, b.B, std::ldexp(interval, -doublings));
  for (int i = 0; i < doublings && step.in_range(); ++i)
    step.make_twice_as_long();
  if (!step.in_range())
    throw std::invalid_argument(fmt::format(
        "noise system grows beyond all numbers within the sampling interval of "
        "{} s",
        interval));

  step.growth.diagonal().array() += 1.0;
  return {
      b.unit.asDiagonal() * step.growth * b.unit.cwiseInverse().asDiagonal(),
      in_units(step.root, b.unit)};
}

double growth_rate(const NoiseSystem& system) {
  check(system);
  return eigenvalues_of(balanced(system).A).real().maxCoeff();
}

MatrixXd stationary_root(const NoiseSystem& system) {
  constexpr double kForgotten = 1e-9;  // its square is left out of Sigma
  constexpr int kMaxDoublings = 100;
  check(system);
  const Balanced b = balanced(system);
  const double slowest = eigenvalues_of(b.A).real().maxCoeff();
  if (!(slowest < 0.0))
    throw std::invalid_argument(
        fmt::format("noise system has no stationary state: an eigenvalue of A "
                    "has real part {} 1/s, must be below 0",
                    slowest));
  Step step = short_step(b.A, b.B, kShort / norm(b.A));
  for (int i = 0; i < kMaxDoublings && step.in_range(); ++i) {
    step.make_twice_as_long();
    MatrixXd transition = step.growth;
    transition.diagonal().array() += 1.0;
    if (norm(transition) < kForgotten) return in_units(step.root, b.unit);
  }
  throw SimulationFailure(
      fmt::format("noise system: its slowest decay, {} 1/s, is too slow beside "
                  "its fastest rate, {} 1/s, to find the stationary state",
                  -slowest, norm(b.A)));
}

LinearNoise::LinearNoise(const NoiseSystem& system, double interval,
                         const RandomStream& stream)
    : interval_(interval), stream_(stream), next_(kDrawnAhead) {
  const SampledNoise sampled = sampled_noise(system, interval);
  const MatrixXd start = stationary_root(system);
  const Index n = system.A.rows();
  step_.resize(n, 2 * n);
  step_ << sampled.transition, sampled.root;
  normals_.resize(n, kDrawnAhead);
  driven_.resize(2 * n);
  VectorXd normals(n);
  stream_.fill_normal(values_of(normals));
  state_ = start * normals;
}

void LinearNoise::advance() {
  const Index n = state_.size();
  if (next_ == kDrawnAhead) {
    stream_.fill_normal(values_of(normals_));
    next_ = 0;
  }
  driven_.head(n) = before_ = state_;
  driven_.tail(n) = normals_.col(next_++);
  state_.noalias() = step_ * driven_;
}

void LinearNoise::undo() {
  state_ = before_;
  --next_;
}

void LinearNoise::refresh(const NoiseSystem& system) {
  const SampledNoise sampled = sampled_noise(system, interval_);
  if (sampled.root.rows() != state_.size())
    throw std::invalid_argument(
        fmt::format("refreshed noise system has {} states, must have {}",
                    sampled.root.rows(), state_.size()));
  step_ << sampled.transition, sampled.root;
}

void LinearNoise::archive(StateArchive& archive) {
  before_.resize(state_.size());
  for (double& z : state_) archive(z);
  for (double& z : before_) archive(z);
  archive(stream_, next_);
  if (!archive.is_reading() || next_ == kDrawnAhead) return;
  const std::uint64_t drawn = stream_.position();
  stream_.seek(drawn - static_cast<std::uint64_t>(normals_.size()));
  stream_.fill_normal(values_of(normals_));
}

}  // namespace beamgyro::internal
