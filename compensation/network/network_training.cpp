// SPDX-License-Identifier: MIT
#include "compensation/network/network_training.h"

#include <algorithm>
#include <cmath>

#include "compensation/network/rate_penalty.h"
#include "parallel/work_queue.h"

namespace beamgyro::internal {
namespace {

constexpr Eigen::Index kBlockRows = 1024;  // keeps a block in the cache
constexpr Eigen::Index kStretches = 20;

// Of each row.
Eigen::ArrayXd squared_errors(const BpNetwork& network,
                              const ScaledRows& rows) {
  Eigen::ArrayXd squares(rows.size());
  for (Eigen::Index first = 0; first < rows.size(); first += kBlockRows) {
    const Eigen::Index count = std::min(kBlockRows, rows.size() - first);
    squares.segment(first, count) =
        (network.predict(rows.inputs.middleRows(first, count)) -
         rows.target.segment(first, count))
            .square();
  }
  return squares;
}

}  // namespace

std::string sentence(StopReason reason) {
  constexpr const char* kSentences[] = {
      "least squares: solved in one step",
      "the in-sample error reached its goal",
      "the gradient vanished: a minimum of the in-sample error",
      "the steps became negligible against the weights",
      "no step lowers the error any more: damping at its limit",
      "no step lowers the error any more: learning rate at its limit",
      "the held-out error no longer falls: stopped early",
      "the largest number of epochs was reached"};
  return kSentences[static_cast<std::size_t>(reason)];
}

void report_epoch(const TrainOptions& options, int epoch, double rms) {
  if (options.observer)
    options.observer(
        {.epoch = static_cast<std::size_t>(epoch),
         .max_epochs = static_cast<std::size_t>(options.max_epochs),
         .rms = rms});
}

double rms_error(const BpNetwork& network, const ScaledRows& rows) {
  return std::sqrt(squared_errors(network, rows).mean());
}

bool no_worse(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& least) {
  const Eigen::Index rows = squares.size();
  const Eigen::Index stretches = std::min(kStretches, rows);
  Eigen::ArrayXd excess(stretches);
  for (Eigen::Index k = 0; k < stretches; ++k) {
    const Eigen::Index first = k * rows / stretches;
    const Eigen::Index count = (k + 1) * rows / stretches - first;
    excess(k) = (squares - least).segment(first, count).mean();
  }
  const auto count = static_cast<double>(stretches);
  const double variance =
      (excess - excess.mean()).square().sum() / std::max(count - 1.0, 1.0);
  return excess.mean() <= 2.0 * std::sqrt(variance / count);
}

bool BestWeights::stale_after(int epoch, const BpNetwork& network,
                              double rate_penalty) {
  if (held_out_.size() == 0) {
    epoch_ = epoch;
    weights_ = network.weights();
    return false;
  }
  const double rms = rms_error(network, held_out_);
  const double here = 0.5 * rms * rms + rate_penalty;
  if (here < lowest_) {
    lowest_ = here;
    rms_ = rms;
    epoch_ = epoch;
    weights_ = network.weights();
  }
  return epoch - epoch_ >= patience_;
}

void BestWeights::restore(const ScaledRows& rows, BpNetwork& network,
                          TrainSummary& summary) const {
  network.set_weights(weights_);
  summary.best_epoch = epoch_;
  summary.in_sample_rms = rms_error(network, rows);
  if (held_out_.size() > 0) summary.held_out_rms = rms_;
}

TrainSummary train_network(const ScaledRows& rows, const ScaledRows& held_out,
                           const TrainOptions& options, RandomStream& order,
                           BpNetwork& network) {
  switch (options.trainer) {
    case Trainer::kIncremental:
      return train_incremental(rows, held_out, options, order, network);
    case Trainer::kGradientAdaptive:
      return train_gradient_adaptive(rows, held_out, options, network);
    case Trainer::kLevenbergMarquardt:
      break;
  }
  return train_levenberg_marquardt(rows, held_out, options, network);
}

std::size_t best_network(const std::vector<BpNetwork>& networks,
                         const ScaledRows& rows, const ScaledRows& held_out,
                         const TrainOptions& options) {
  std::vector<Eigen::ArrayXd> squares;
  std::vector<double> sums;
  Eigen::ArrayXd least;
  for (const BpNetwork& network : networks) {
    const double penalty =
        2.0 * RatePenalty(network, rows, options).value(network.weights());
    squares.push_back(squared_errors(network, held_out) + penalty);
    sums.push_back(squares.back().sum() +
                   (squared_errors(network, rows) + penalty).sum());
    if (least.size() == 0 || squares.back().mean() < least.mean())
      least = squares.back();
  }
  std::size_t best = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < networks.size(); ++k)
    if (sums[k] < lowest &&
        (held_out.size() == 0 || no_worse(squares[k], least))) {
      lowest = sums[k];
      best = k;
    }
  return best;
}

Restarts train_from_restarts(const std::vector<int>& layer_sizes,
                             const ScaledRows& rows, const ScaledRows& held_out,
                             const TrainOptions& options, std::uint64_t seed) {
  const auto count = static_cast<std::size_t>(options.restarts);
  std::vector<BpNetwork> networks(count, BpNetwork(layer_sizes));
  std::vector<TrainSummary> summaries(count);
  const std::size_t cores =
      thread_count(static_cast<unsigned>(std::max(options.cores, 0)));
  const std::size_t at_once = std::min(cores, count);
  TrainOptions of_one = options;
  of_one.threads = std::max(options.threads, static_cast<int>(cores / at_once));
  for_each_task(count, at_once, [&](std::size_t k, std::size_t) {
    const auto run = static_cast<std::uint32_t>(k);
    RandomStream initial(seed, 0, run, kInitialWeightsStream);
    RandomStream order(seed, 0, run, kSampleOrderStream);
    networks[k].randomise(initial);
    TrainOptions own = of_one;
    if (options.observer) {
      own.observer = [&](TrainingProgress report) {
        report.restart = k + 1;
        report.restarts = count;
        options.observer(report);
      };
    }
    summaries[k] = train_network(rows, held_out, own, order, networks[k]);
  });
  const std::size_t chosen = best_network(networks, rows, held_out, options);
  return {std::move(summaries), chosen, std::move(networks[chosen])};
}

}  // namespace beamgyro::internal
