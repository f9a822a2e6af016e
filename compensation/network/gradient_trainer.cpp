// SPDX-License-Identifier: MIT
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "compensation/network/network_training.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Fisher-Yates.
void shuffle_rows(std::vector<Index>& order, RandomStream& random) {
  for (std::size_t n = order.size(); n > 1; --n) {
    const auto k =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    std::swap(order[n - 1], order[k]);
  }
}

void check_finite(double rms, double learning_rate) {
  if (!std::isfinite(rms))
    throw std::runtime_error(
        "bp training diverged: the error is no longer finite with a learning "
        "rate of " +
        std::to_string(learning_rate) + "; a smaller learning_rate is needed");
}

// Calls `epoch`, which returns the in-sample rms, until the goal is reached,
// `why_stop` has a reason, or the held-out error rises.
template <class Epoch, class WhyStop>
TrainSummary train_by_epochs(const ScaledRows& rows, const ScaledRows& held_out,
                             const TrainOptions& options, BpNetwork& network,
                             const Epoch& epoch, const WhyStop& why_stop) {
  TrainSummary summary;
  BestWeights best(held_out, options.patience);
  std::optional<StopReason> stop;
  while (!stop && summary.epochs < options.max_epochs) {
    ++summary.epochs;
    const double rms = epoch();
    report_epoch(options, summary.epochs, rms);
    const bool stale = best.stale_after(summary.epochs, network);
    stop = rms <= options.goal ? StopReason::kGoalReached : why_stop();
    if (!stop && stale) stop = StopReason::kHeldOutRising;
  }
  summary.stop_reason = stop.value_or(StopReason::kMaxEpochs);
  best.restore(rows, network, summary);
  return summary;
}

}  // namespace

bool AdaptiveRate::keep_step(double old_error, double new_error) {
  if (!(new_error <= 1.05 * old_error)) {
    rate *= 0.70;
    return false;
  }
  if (new_error < old_error) rate *= 1.05;
  return true;
}

TrainSummary train_incremental(const ScaledRows& rows,
                               const ScaledRows& held_out,
                               const TrainOptions& options, RandomStream& order,
                               BpNetwork& network) {
  std::vector<Index> sequence(static_cast<std::size_t>(rows.size()));
  std::iota(sequence.begin(), sequence.end(), 0);
  VectorXd step = VectorXd::Zero(network.weights().size()), gradient;
  const auto epoch = [&] {
    shuffle_rows(sequence, order);
    for (const Index k : sequence) {
      network.predict_with_gradient(rows.inputs.middleRows(k, 1),
                                    rows.target.segment(k, 1), gradient);
      step = options.momentum * step - options.learning_rate * gradient;
      network.set_weights(network.weights() + step);
    }
    const double rms = rms_error(network, rows);
    check_finite(rms, options.learning_rate);
    return rms;
  };
  return train_by_epochs(rows, held_out, options, network, epoch,
                         [] { return std::optional<StopReason>(); });
}

TrainSummary train_gradient_adaptive(const ScaledRows& rows,
                                     const ScaledRows& held_out,
                                     const TrainOptions& options,
                                     BpNetwork& network) {
  AdaptiveRate adaptive{options.learning_rate};
  const double count = static_cast<double>(rows.size());
  VectorXd gradient, trial_gradient;
  const auto squares = [&](VectorXd& of_sum) {
    return (network.predict_with_gradient(rows.inputs, rows.target, of_sum) -
            rows.target)
        .square()
        .sum();
  };
  double error = squares(gradient);
  VectorXd step = VectorXd::Zero(gradient.size());
  const auto epoch = [&] {
    const VectorXd w = network.weights();
    step = options.momentum * step - adaptive.rate / count * gradient;
    network.set_weights(w + step);
    const double trial = squares(trial_gradient);
    if (adaptive.keep_step(error, trial)) {
      error = trial;
      gradient.swap(trial_gradient);
    } else {
      network.set_weights(w);
      step.setZero();
    }
    return std::sqrt(error / count);
  };
  const auto why_stop = [&]() -> std::optional<StopReason> {
    if (gradient.lpNorm<Eigen::Infinity>() <= options.min_gradient * count)
      return StopReason::kGradientSmall;
    if (adaptive.rate < options.min_learning_rate)
      return StopReason::kRateSmall;
    return std::nullopt;
  };
  return train_by_epochs(rows, held_out, options, network, epoch, why_stop);
}

}  // namespace beamgyro::internal
