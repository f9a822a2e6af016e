// SPDX-License-Identifier: MIT
#include "compensation/network/lbfgs_trainer.h"

#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <ceres/iteration_callback.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "compensation/network/batch_network.h"

namespace beamgyro {
namespace {

using Eigen::VectorXd;

constexpr int kRank = 40;  // steps the inverse Hessian remembers

// F and dF/dw.
class LbfgsObjective final : public ceres::FirstOrderFunction {
 public:
  LbfgsObjective(const ScaledRows& rows, const TrainOptions& options,
                 const BpNetwork& network)
      : batch_(network.layer_sizes(), rows, options.threads),
        weights_(static_cast<int>(network.weights().size())),
        count_(static_cast<double>(rows.size())),
        decay_(options.weight_decay) {}

  int NumParameters() const override { return weights_; }

  bool Evaluate(const double* parameters, double* cost,
                double* gradient) const override {
    const VectorXd w = Eigen::Map<const VectorXd>(parameters, weights_);
    *cost = 0.5 * batch_.sum_of_squares(w) / count_ +
            0.5 * decay_ * w.squaredNorm();
    if (gradient != nullptr)
      Eigen::Map<VectorXd>(gradient, weights_) =
          batch_.gradient() / count_ + decay_ * w;
    return std::isfinite(*cost);
  }

 private:
  mutable BatchNetwork batch_;
  int weights_;
  double count_, decay_;
};

// Our stopping rules, tested after each epoch.
class Watch final : public ceres::IterationCallback {
 public:
  Watch(const TrainOptions& options, const VectorXd& w, BpNetwork& network,
        BestWeights& best, TrainSummary& summary)
      : options_(options),
        w_(w),
        network_(network),
        best_(best),
        summary_(summary) {}

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& iteration) override {
    network_.set_weights(w_);
    summary_.epochs = iteration.iteration;
    const bool stale = best_.stale_after(summary_.epochs, network_);
    const double norm = w_.norm();
    const double rms =
        std::sqrt(2.0 * iteration.cost - options_.weight_decay * norm * norm);
    report_epoch(options_, summary_.epochs, rms);
    if (options_.goal > 0.0 && rms <= options_.goal)
      stop = StopReason::kGoalReached;
    else if (iteration.gradient_max_norm <= options_.min_gradient)
      stop = StopReason::kGradientSmall;
    else if (iteration.iteration > 0 &&
             iteration.step_norm <=
                 options_.min_step * (norm + options_.min_step))
      stop = StopReason::kStepSmall;
    else if (stale)
      stop = StopReason::kHeldOutRising;
    return stop ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  std::optional<StopReason> stop;

 private:
  const TrainOptions& options_;
  const VectorXd& w_;
  BpNetwork& network_;
  BestWeights& best_;
  TrainSummary& summary_;
};

}  // namespace

TrainSummary train_lbfgs(const ScaledRows& rows, const ScaledRows& held_out,
                         const TrainOptions& options, BpNetwork& network) {
  TrainSummary summary;
  BestWeights best(held_out, options.patience);
  best.stale_after(0, network);
  VectorXd w = network.weights();
  Watch watch(options, w, network, best, summary);
  ceres::GradientProblemSolver::Options solver;
  solver.max_lbfgs_rank = kRank;
  solver.use_approximate_eigenvalue_bfgs_scaling = true;
  solver.max_num_iterations = options.max_epochs;
  solver.function_tolerance = 0.0;  // Watch decides
  solver.gradient_tolerance = 0.0;
  solver.parameter_tolerance = 0.0;
  solver.logging_type = ceres::SILENT;
  solver.update_state_every_iteration = true;
  solver.callbacks.push_back(&watch);
  const ceres::GradientProblem problem(
      new LbfgsObjective(rows, options, network));  // which owns it
  ceres::GradientProblemSolver::Summary outcome;
  ceres::Solve(solver, problem, w.data(), &outcome);
  const StopReason otherwise = outcome.termination_type == ceres::NO_CONVERGENCE
                                   ? StopReason::kMaxEpochs
                                   : StopReason::kLineSearchFailed;
  summary.stop_reason = watch.stop.value_or(otherwise);
  best.restore(rows, network, summary);
  if (!std::isfinite(summary.in_sample_rms))
    throw std::runtime_error(
        "bp training: the error of the initial weights is not finite");
  return summary;
}

}  // namespace beamgyro
