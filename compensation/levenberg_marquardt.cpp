// SPDX-License-Identifier: MIT
#include "compensation/levenberg_marquardt.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace beamgyro {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlockRows = 256;  // J of a block stays in the L2 cache

// J^T J / N + decay I (lower triangle) and dF/dw at the present weights.
struct NormalEquations {
  MatrixXd matrix;
  VectorXd gradient;
  MatrixXd jacobian;  // of one block

  void accumulate(const BpNetwork& network, const ScaledRows& rows,
                  double decay) {
    const Index weights = network.weights().size();
    const double scale = 1.0 / static_cast<double>(rows.size());
    matrix.setZero(weights, weights);
    gradient.setZero(weights);
    for (Index first = 0; first < rows.size(); first += kBlockRows) {
      const Index count = std::min(kBlockRows, rows.size() - first);
      const VectorXd error =
          (network.predict_with_jacobian(rows.inputs.middleRows(first, count),
                                         jacobian) -
           rows.target.segment(first, count))
              .matrix();
      matrix.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose(),
                                                        scale);
      gradient.noalias() += scale * (jacobian.transpose() * error);
    }
    matrix.diagonal().array() += decay;
    gradient += decay * network.weights();
  }
};

double objective(const BpNetwork& network, const ScaledRows& rows,
                 double decay) {
  const double rms = rms_error(network, rows);
  return 0.5 * rms * rms + 0.5 * decay * network.weights().squaredNorm();
}

// What stops the iteration before the next step, if anything does.
std::optional<StopReason> reason_to_stop(const TrainOptions& options,
                                         const NormalEquations& equations,
                                         const BpNetwork& network,
                                         const ScaledRows& rows) {
  if (options.goal > 0.0 && rms_error(network, rows) <= options.goal)
    return StopReason::kGoalReached;
  if (equations.gradient.lpNorm<Eigen::Infinity>() <= options.min_gradient)
    return StopReason::kGradientSmall;
  return std::nullopt;
}

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

}  // namespace

TrainSummary train_levenberg_marquardt(const ScaledRows& rows,
                                       const ScaledRows& held_out,
                                       const TrainOptions& options,
                                       BpNetwork& network) {
  TrainSummary summary;
  BestWeights best(held_out, options.patience);
  best.stale_after(0, network);
  NormalEquations equations;
  equations.accumulate(network, rows, options.weight_decay);
  double F = objective(network, rows, options.weight_decay);
  Damping mu{options.initial_damping};
  std::optional<StopReason> stop =
      reason_to_stop(options, equations, network, rows);
  while (!stop && summary.epochs < options.max_epochs) {
    ++summary.epochs;
    MatrixXd damped = equations.matrix;
    damped.diagonal().array() += mu.value;
    const VectorXd w = network.weights();
    const VectorXd step =
        -damped.selfadjointView<Eigen::Lower>().llt().solve(equations.gradient);
    if (step.norm() <= options.min_step * (w.norm() + options.min_step)) {
      stop = StopReason::kStepSmall;
      break;
    }
    network.set_weights(w + step);
    const double trial = objective(network, rows, options.weight_decay);
    const double predicted =
        0.5 * step.dot(mu.value * step - equations.gradient);
    if (trial < F) {
      mu.step_kept((F - trial) / predicted);
      F = trial;
      equations.accumulate(network, rows, options.weight_decay);
      stop = reason_to_stop(options, equations, network, rows);
      if (best.stale_after(summary.epochs, network) && !stop)
        stop = StopReason::kHeldOutRising;
    } else {
      network.set_weights(w);
      mu.step_discarded();
      if (mu.value > options.max_damping) stop = StopReason::kDampingLimit;
    }
  }
  summary.stop_reason = stop.value_or(StopReason::kMaxEpochs);
  best.restore(rows, network, summary);
  return summary;
}

}  // namespace beamgyro
