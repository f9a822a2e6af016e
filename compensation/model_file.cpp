// SPDX-License-Identifier: MIT
#include "compensation/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace beamgyro {
namespace {

std::vector<Input> read_inputs(const ConfigTable& root) {
  const std::vector<std::string> names = root.texts("inputs");
  if (names.empty()) root.fail("inputs", "[], needs at least one input");
  std::vector<Input> inputs;
  for (const std::string& name : names) {
    try {
      inputs.push_back(parse_input(name));
    } catch (const std::invalid_argument& error) {
      root.fail("inputs", error.what());
    }
    if (std::count(inputs.begin(), inputs.end(), inputs.back()) > 1)
      root.fail("inputs", fmt::format("\"{}\" is there twice", name));
  }
  return inputs;
}

void require_one_temperature(const ConfigTable& root,
                             const std::vector<Input>& inputs,
                             const std::string& kind) {
  if (inputs.size() != 1 || inputs[0].column != "temperature")
    root.fail("inputs",
              fmt::format("{} inputs starting with \"{}\"; a {} takes one "
                          "input, \"temperature\" or \"temperature_lowpass"
                          "(TAU)\"",
                          inputs.size(), input_name(inputs[0]), kind));
}

RowOptions read_rows(const ConfigTable& table) {
  RowOptions rows;
  rows.seconds = table.number_or("seconds", rows.seconds, positive());
  rows.steady_K_per_min = table.optional_number("steady_K_per_min", positive());
  return rows;
}

SplineSpec read_spline(const ConfigTable& table) {
  SplineSpec spec;
  spec.knot_spacing_K =
      table.number_or("knot_spacing_K", spec.knot_spacing_K, positive());
  spec.end = table.choice_or("ends", "not_a_knot", {"not_a_knot", "natural"}) ==
                     "natural"
                 ? SplineEnd::kNatural
                 : SplineEnd::kNotAKnot;
  return spec;
}

Trainer read_trainer(const ConfigTable& table) {
  const std::string name = table.choice_or(
      "trainer", "levenberg_marquardt",
      {"levenberg_marquardt", "lbfgs", "gradient_adaptive", "incremental"});
  if (name == "incremental") return Trainer::kIncremental;
  if (name == "gradient_adaptive") return Trainer::kGradientAdaptive;
  if (name == "lbfgs") return Trainer::kLbfgs;
  return Trainer::kLevenbergMarquardt;
}

BpSpec read_bp(const ConfigTable& table) {
  BpSpec spec;
  for (const long neurons : table.integers("hidden", 1, 1000))
    spec.hidden.push_back(static_cast<int>(neurons));
  if (spec.hidden.empty())
    table.fail("hidden", "[], needs at least one hidden layer, as [6]");
  TrainOptions& training = spec.training;
  training.trainer = read_trainer(table);
  const bool lbfgs = training.trainer == Trainer::kLbfgs;
  if (lbfgs || training.trainer == Trainer::kLevenbergMarquardt) {
    if (lbfgs) {
      training.max_epochs = kLbfgsMaxEpochs;
      training.patience = kLbfgsPatience;
    }
    training.weight_decay =
        table.number_or("weight_decay", training.weight_decay, non_negative());
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
  return spec;
}

}  // namespace

ModelSpec read_model(const std::filesystem::path& file) {
  return read_model(ConfigDocument::read(file));
}

ModelSpec read_model(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  ModelSpec spec;
  spec.text = document.text();
  const std::string kind = root.choice("kind", {"polynomial", "spline", "bp"});
  spec.inputs = read_inputs(root);
  spec.rows = read_rows(root.table_or_empty("rows"));
  if (kind == "bp") {
    spec.kind = read_bp(root.table("bp"));
  } else {
    require_one_temperature(root, spec.inputs, kind);
    const ConfigTable table = root.table_or_empty(kind);
    if (kind == "spline")
      spec.kind = read_spline(table);
    else
      spec.kind = PolynomialSpec{
          static_cast<int>(table.integer_or("degree", 3, 0, 12))};
  }
  document.reject_unknown_keys();
  return spec;
}

}  // namespace beamgyro
