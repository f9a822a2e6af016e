// SPDX-License-Identifier: MIT
#include "compensation/methods/bp_method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/method_inputs.h"

namespace beamgyro::internal {

namespace {

const std::vector<double> kWeightDecays = {0.0, 1e-8, 1e-6};

Trainer read_trainer(const ConfigTable& table) {
  const std::string name = table.choice_or(
      "trainer", "levenberg_marquardt",
      {"levenberg_marquardt", "gradient_adaptive", "incremental"});
  if (name == "incremental") return Trainer::kIncremental;
  if (name == "gradient_adaptive") return Trainer::kGradientAdaptive;
  return Trainer::kLevenbergMarquardt;
}

std::vector<double> read_weight_decays(const ConfigTable& table) {
  if (const auto fixed = table.optional_number("weight_decay", non_negative()))
    return {*fixed};
  if (!table.has("weight_decays")) return kWeightDecays;
  std::vector<double> decays = table.numbers("weight_decays", non_negative());
  if (decays.empty())
    table.fail("weight_decays", "[], needs at least one value to choose from");
  return decays;
}

// Change of the scaled inputs with the rate, in units of the scaled bias.
std::vector<double> rate_direction(const FitTask& task,
                                   const BiasModel& model) {
  std::vector<double> direction(task.inputs.size(), 0.0);
  for (std::size_t i = 0; i < task.inputs.size(); ++i)
    if (sees_the_rate(task.inputs[i]))
      direction[i] =
          (task.inputs[i].column == "output" ? task.rows.output_per_rate
                                             : 1.0) *
          model.bias_scale.half_width / model.input_scales[i].half_width;
  return direction;
}

ScaledRows scaled_rows(const TrainingRows& rows, const BiasModel& model) {
  if (rows.size() == 0) return {};
  return {scaled(rows.inputs, model.input_scales),
          (rows.bias - model.bias_scale.centre) / model.bias_scale.half_width};
}

// A network of far more weights than rows learns them by heart, and its normal
// equations take hours.
void require_rows(const std::vector<int>& layers, const FitTask& task) {
  constexpr Eigen::Index kMostPerRow = 8;
  const Eigen::Index weights = BpNetwork(layers).weights().size();
  if (weights <= kMostPerRow * std::max<Eigen::Index>(task.rows.size(), 60))
    return;
  throw std::invalid_argument(fmt::format(
      "bp: hidden = [{}] has {} weights for {} training rows; expected at most "
      "{} a row: fewer neurons, longer recordings, or a shorter rows.seconds",
      fmt::join(layers.begin() + 1, layers.end() - 1, ", "), weights,
      task.rows.size(), kMostPerRow));
}

std::string shown(double decay, const TrainSummary& best, double unit) {
  return fmt::format("weight decay {:g}: rms in-sample {:.6f}{} deg/s", decay,
                     best.in_sample_rms * unit,
                     best.held_out_rms ? fmt::format(", held-out {:.6f}",
                                                     *best.held_out_rms * unit)
                                       : "");
}

}  // namespace

BpSpec BpSpec::read_options(const MethodSource& source) {
  const ConfigTable table = source.table(kName);
  BpSpec spec;
  TrainOptions& training = spec.training;
  training.trainer = read_trainer(table);
  if (training.trainer == Trainer::kLevenbergMarquardt) {
    spec.weight_decays = read_weight_decays(table);
    training.rate_penalty =
        table.number_or("rate_penalty", training.rate_penalty, non_negative());
  } else {
    training.max_epochs = kGradientMaxEpochs;
    training.patience = kGradientPatience;
    training.learning_rate =
        table.number_or("learning_rate", training.learning_rate, positive());
    training.momentum =
        table.number_or("momentum", training.momentum,
                        Range{.low = 0.0, .high = 1.0, .high_open = true});
  }
  const auto count = [&](const char* key, int otherwise, long high) {
    return static_cast<int>(table.integer_or(key, otherwise, 1, high));
  };
  training.restarts = count("restarts", training.restarts, 1000);
  training.max_epochs = count("max_epochs", training.max_epochs, 10000000);
  training.patience = count("patience", training.patience, 10000000);
  spec.goal_deg_per_s =
      table.number_or("goal_deg_per_s", spec.goal_deg_per_s, non_negative());
  if (training.rate_penalty > 0.0 &&
      std::none_of(source.inputs.begin(), source.inputs.end(), sees_the_rate))
    table.fail("rate_penalty",
               "is for networks with the input \"output\" or \"rate\"; these "
               "inputs do not feel the rate");
  return spec;
}

BpSpec BpSpec::read(MethodSource& source) {
  const ConfigTable table = source.root().table(kName);
  BpSpec spec = read_options(source);
  for (const long neurons : table.integers("hidden", 1, 1000))
    spec.hidden.push_back(static_cast<int>(neurons));
  if (spec.hidden.empty())
    table.fail("hidden", "[], needs at least one hidden layer, as [6]");
  return spec;
}

std::string BpSpec::method_name() const {
  return fmt::format("BP network {}", fmt::join(hidden, "-"));
}

Fit BpSpec::fit(const FitTask& task) const {
  std::vector<int> sizes{static_cast<int>(task.inputs.size())};
  sizes.insert(sizes.end(), hidden.begin(), hidden.end());
  sizes.push_back(1);
  require_rows(sizes, task);
  Fit fit = BiasModel{scales_of(task),
                      scale_to_unit(task.rows.bias, "rate - true_rate"),
                      BpNetwork(sizes)};
  const double unit = fit.model.bias_scale.half_width;  // [deg/s]
  TrainOptions options = training;
  options.goal = goal_deg_per_s / unit;
  options.rate_direction = rate_direction(task, fit.model);
  if (training.observer) {
    options.observer = [&](TrainingProgress report) {
      report.rms *= unit;
      training.observer(report);
    };
  }
  const ScaledRows rows = scaled_rows(task.rows, fit.model);
  const ScaledRows unseen = scaled_rows(task.held_out, fit.model);
  std::vector<Restarts> of_decays;
  std::vector<BpNetwork> networks;
  for (const double decay : weight_decays) {
    options.weight_decay = decay;
    of_decays.push_back(
        train_from_restarts(sizes, rows, unseen, options, task.seed));
    const Restarts& last = of_decays.back();
    networks.push_back(last.network);
    if (weight_decays.size() > 1)
      fit.choices.push_back(shown(decay, last.summaries[last.chosen], unit));
  }
  const std::size_t kept = best_network(networks, rows, unseen, options);
  if (weight_decays.size() > 1)
    fit.choices.push_back(
        fmt::format("kept weight decay {:g}", weight_decays[kept]));
  fit.restarts = std::move(of_decays[kept].summaries);
  fit.chosen = of_decays[kept].chosen;
  fit.model.function = std::move(networks[kept]);
  for (TrainSummary& summary : fit.restarts) {
    summary.in_sample_rms *= unit;
    if (summary.held_out_rms) *summary.held_out_rms *= unit;
  }
  return fit;
}

}  // namespace beamgyro::internal
