// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "compensation/network/batch_network.h"
#include "compensation/network/rate_penalty.h"
#include "linear_algebra/cholesky.h"

namespace beamgyro::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMaxAcceleration = 0.75;

// F, its gradient and its Gauss-Newton matrix.
class LeastSquaresObjective {
 public:
  LeastSquaresObjective(const BpNetwork& network, const ScaledRows& rows,
                        const TrainOptions& options)
      : batch_(network.layer_sizes(), rows, options.threads),
        penalty_(network, rows, options),
        count_(static_cast<double>(rows.size())),
        decay_(options.weight_decay) {}

  double value(const VectorXd& w) {
    squares_ = batch_.sum_of_squares(w);
    penalised_ = penalty_.value(w);
    return 0.5 * squares_ / count_ + 0.5 * decay_ * w.squaredNorm() +
           penalised_;
  }

  /// The rate penalty of the last value().
  double penalised() const { return penalised_; }

  /// rms error of the last value().
  double rms() const { return std::sqrt(squares_ / count_); }

  /// J^T J / N + decay I + the penalty's (lower triangle) and dF/dw where the
  /// last value() was taken, at w.
  void linearise(const VectorXd& w, MatrixXd& matrix, VectorXd& gradient) {
    batch_.normal_equations(matrix, gradient);
    matrix /= count_;
    matrix.diagonal().array() += decay_;
    gradient = gradient / count_ + decay_ * w;
    penalty_.add_to(w, matrix, gradient);
  }

  /// J^T d2y/dt2 / N at t = 0 along w + t v, w being that of the last value().
  VectorXd curvature(const VectorXd& v) { return batch_.curvature(v) / count_; }

 private:
  BatchNetwork batch_;
  RatePenalty penalty_;
  double count_, decay_;
  double squares_ = 0.0, penalised_ = 0.0;
};

// The damping of Nielsen.
struct Damping {
  double value;
  double growth = 2.0;

  void step_kept(double rho) {
    value *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * rho - 1.0, 3));
    growth = 2.0;
  }
  void step_discarded() {
    value *= growth;
    growth *= 2.0;
  }
};

std::optional<StopReason> reason_to_stop(const TrainOptions& options,
                                         const LeastSquaresObjective& objective,
                                         const VectorXd& gradient) {
  if (options.goal > 0.0 && objective.rms() <= options.goal)
    return StopReason::kGoalReached;
  if (gradient.lpNorm<Eigen::Infinity>() <= options.min_gradient)
    return StopReason::kGradientSmall;
  return std::nullopt;
}

}  // namespace

TrainSummary train_levenberg_marquardt(const ScaledRows& rows,
                                       const ScaledRows& held_out,
                                       const TrainOptions& options,
                                       BpNetwork& network) {
  TrainSummary summary;
  BestWeights best(held_out, options.patience);
  LeastSquaresObjective objective(network, rows, options);
  VectorXd w = network.weights(), gradient;
  MatrixXd matrix;
  double F = objective.value(w);
  best.stale_after(0, network, objective.penalised());
  objective.linearise(w, matrix, gradient);
  Damping mu{options.initial_damping};
  std::optional<StopReason> stop = reason_to_stop(options, objective, gradient);
  while (!stop && summary.epochs < options.max_epochs) {
    ++summary.epochs;
    MatrixXd damped = matrix;
    damped.diagonal().array() += mu.value;
    const Cholesky solver(damped);
    const VectorXd v = -solver.solve(gradient);
    if (v.norm() <= options.min_step * (w.norm() + options.min_step)) {
      stop = StopReason::kStepSmall;
      break;
    }
    const VectorXd a = -0.5 * solver.solve(objective.curvature(v));
    const bool bent = !(2.0 * a.norm() <= kMaxAcceleration * v.norm());
    const VectorXd there = w + v + a;
    const double trial = bent ? F : objective.value(there);
    if (trial < F) {
      mu.step_kept((F - trial) / (0.5 * v.dot(mu.value * v - gradient)));
      F = trial;
      w = there;
      network.set_weights(w);
      objective.linearise(w, matrix, gradient);
      stop = reason_to_stop(options, objective, gradient);
      if (best.stale_after(summary.epochs, network, objective.penalised()) &&
          !stop)
        stop = StopReason::kHeldOutRising;
    } else {
      if (!bent) objective.value(w);  // back to where curvature() is wanted
      mu.step_discarded();
      if (mu.value > options.max_damping) stop = StopReason::kDampingLimit;
    }
    report_epoch(options, summary.epochs, objective.rms());
  }
  summary.stop_reason = stop.value_or(StopReason::kMaxEpochs);
  best.restore(rows, network, summary);
  return summary;
}

}  // namespace beamgyro::internal
