// SPDX-License-Identifier: MIT
#include "compensation/network/restarts.h"

#include <algorithm>
#include <limits>

#include "compensation/network/rate_penalty.h"
#include "parallel/work_queue.h"
#include "random/random_stream.h"

namespace beamgyro::internal {

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
      own.observer = [&](EpochReport report) {
        report.restart = static_cast<int>(k) + 1;
        report.restarts = options.restarts;
        options.observer(report);
      };
    }
    summaries[k] = train_network(rows, held_out, own, order, networks[k]);
  });
  const std::size_t chosen = best_network(networks, rows, held_out, options);
  return {std::move(summaries), chosen, std::move(networks[chosen])};
}

}  // namespace beamgyro::internal
