// SPDX-License-Identifier: MIT
// Data and start weights of the comparison of trainers, and our own training
// on them; bench/compare_trainers.py drives it.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bias_rows.h"
#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

using nlohmann::json;

struct Case {
  std::vector<int> layer_sizes;
  ScaledRows rows;
};

Case case_named(const std::string& name) {
  if (name == "soak") return {{1, 6, 1}, bias_rows(37, 1, 0.0, 0)};
  if (name == "noisy") return {{1, 6, 1}, bias_rows(37, 1, 0.005, 0)};
  if (name == "rows") return {{3, 14, 1}, bias_rows(20000, 3, 0.002, 0)};
  throw std::invalid_argument(name + ": must be soak or rows");
}

BpNetwork start(const Case& c, std::uint32_t seed) {
  RandomStream random(1, 0, seed, kInitialWeightsStream);
  BpNetwork network(c.layer_sizes);
  network.randomise(random);
  return network;
}

json data(const Case& c, std::uint32_t seeds) {
  json inputs = json::array(), weights = json::array();
  for (Eigen::Index i = 0; i < c.rows.inputs.cols(); ++i) {
    const Eigen::ArrayXd column = c.rows.inputs.col(i);
    inputs.push_back(std::vector<double>(column.begin(), column.end()));
  }
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const Eigen::VectorXd w = start(c, seed).weights();
    weights.push_back(std::vector<double>(w.begin(), w.end()));
  }
  return {{"layer_sizes", c.layer_sizes},
          {"inputs", inputs},  // one list per input
          {"target",
           std::vector<double>(c.rows.target.begin(), c.rows.target.end())},
          {"weights", weights}};  // W_1 column by column, b_1, W_2, b_2
}

// Median time of as many trainings as fit into a fifth of a second.
json trained(const Case& c, std::uint32_t seed, const TrainOptions& options) {
  const auto now = [&] {  // a loaded machine tells the processor time apart
    if (options.threads == 1)
      return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  const BpNetwork initial = start(c, seed);
  std::vector<double> took;
  TrainSummary summary;
  double total = 0;
  while (took.size() < 3 || (total < 0.2 && took.size() < 101)) {
    if (total > 10) break;
    BpNetwork network = initial;
    RandomStream order(1, 0, seed, kSampleOrderStream);
    const double begin = now();
    summary = train_network(c.rows, {}, options, order, network);
    took.push_back(now() - begin);
    total += took.back();
  }
  std::nth_element(took.begin(),
                   took.begin() + static_cast<long>(took.size() / 2),
                   took.end());
  return {{"rms", summary.in_sample_rms},
          {"epochs", summary.epochs},
          {"seconds", took[took.size() / 2]},
          {"stop", sentence(summary.stop_reason)}};
}

int run(const std::vector<std::string>& words) {
  const Case c = case_named(words[0]);
  if (words.size() == 2) {
    const auto seeds = static_cast<std::uint32_t>(std::stoul(words[1]));
    std::cout << data(c, seeds).dump() << '\n';
    return 0;
  }
  TrainOptions options;
  const auto seed = static_cast<std::uint32_t>(std::stoul(words[1]));
  options.threads = std::stoi(words[2]);
  options.max_epochs = std::stoi(words[3]);
  json results = json::array();
  for (std::size_t k = 4; k < words.size(); ++k) {
    options.goal = std::stod(words[k]);
    results.push_back(trained(c, seed, options));
  }
  std::cout << results.dump() << '\n';
  return 0;
}

}  // namespace
}  // namespace beamgyro::internal

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() != 2 && words.size() < 5) {
    std::cerr << "usage: beamgyro_trainer soak|rows SEEDS\n"
                 "       beamgyro_trainer soak|rows SEED THREADS EPOCHS "
                 "GOAL...\n";
    return 2;
  }
  return beamgyro::internal::run(words);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
