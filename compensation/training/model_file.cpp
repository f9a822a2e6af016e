// SPDX-License-Identifier: MIT
#include "compensation/training/model_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "compensation/compensator/compensator_file.h"
#include "config/suggestion.h"
#include "dataset/files/sha256.h"

namespace beamgyro {
namespace {

const std::vector<std::string> kKinds = {
    "none", "constant",   "polynomial", "table", "spline",
    "px4",  "ardupilot",  "thermistor", "fuzzy", "bp",
    "auto", "population", "adapted"};

const std::vector<double> kWeightDecays = {0.0, 1e-8, 1e-6};

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

bool takes_samples(const std::string& kind) {
  return kind == "px4" || kind == "ardupilot";
}

void require_one_temperature(const ConfigTable& root,
                             const std::vector<Input>& inputs,
                             const std::string& kind) {
  const bool of_samples = takes_samples(kind);
  const bool one =
      inputs.size() == 1 &&
      (inputs[0] == parse_input("temperature") ||
       (inputs[0].kind == InputKind::kTemperatureLowpass && !of_samples));
  if (!one)
    root.fail(
        "inputs",
        fmt::format("{} inputs starting with \"{}\"; a {} takes one "
                    "input, \"temperature\"{}",
                    inputs.size(), input_name(inputs[0]), kind,
                    of_samples ? "" : " or \"temperature_lowpass(TAU)\""));
}

void require_temperature_first(const ConfigTable& root,
                               const std::vector<Input>& inputs,
                               const std::string& kind) {
  if (inputs[0] != parse_input("temperature"))
    root.fail("inputs", fmt::format("starts with \"{}\"; the first input of a "
                                    "{} is \"temperature\"",
                                    input_name(inputs[0]), kind));
  for (const Input& input : inputs)
    if (sees_the_rate(input))
      root.fail("inputs",
                fmt::format("\"{}\" feels the rate, and a {} would take the "
                            "rate for drift; only a bp network takes it, with "
                            "rate_penalty",
                            input_name(input), kind));
}

RowOptions read_rows(const ConfigTable& table, const std::string& kind) {
  RowOptions rows;
  rows.seconds = table.number_or(
      "seconds", takes_samples(kind) ? 0.0 : rows.seconds, non_negative());
  rows.steady_K_per_min = table.optional_number("steady_K_per_min", positive());
  if (rows.steady_K_per_min && rows.seconds == 0.0)
    table.fail("steady_K_per_min",
               "is the slope over the seconds of a row, and seconds is 0");
  return rows;
}

PolynomialSpec read_polynomial(const ConfigTable& table) {
  return {static_cast<int>(table.integer_or("degree", 3, 0, 12)),
          table.flag_or("normalised", true)};
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

std::vector<double> read_weight_decays(const ConfigTable& table) {
  if (const auto fixed = table.optional_number("weight_decay", non_negative()))
    return {*fixed};
  if (!table.has("weight_decays")) return kWeightDecays;
  std::vector<double> decays = table.numbers("weight_decays", non_negative());
  if (decays.empty())
    table.fail("weight_decays", "[], needs at least one value to choose from");
  return decays;
}

// Everything but the layers.
BpSpec read_bp_options(const ConfigTable& table) {
  BpSpec spec;
  TrainOptions& training = spec.training;
  training.trainer = read_trainer(table);
  const bool lbfgs = training.trainer == Trainer::kLbfgs;
  if (lbfgs || training.trainer == Trainer::kLevenbergMarquardt) {
    if (lbfgs) {
      training.max_epochs = kLbfgsMaxEpochs;
      training.patience = kLbfgsPatience;
    }
    spec.weight_decays = read_weight_decays(table);
    if (!lbfgs)
      training.rate_penalty = table.number_or(
          "rate_penalty", training.rate_penalty, non_negative());
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

void require_inputs_for_penalty(const ConfigTable& table, const BpSpec& spec,
                                const std::vector<Input>& inputs) {
  if (spec.training.rate_penalty > 0.0 &&
      std::none_of(inputs.begin(), inputs.end(), sees_the_rate))
    table.fail("rate_penalty",
               "is for networks with the input \"output\" or \"rate\"; these "
               "inputs do not feel the rate");
}

BpSpec read_bp(const ConfigTable& table, const std::vector<Input>& inputs) {
  BpSpec spec = read_bp_options(table);
  for (const long neurons : table.integers("hidden", 1, 1000))
    spec.hidden.push_back(static_cast<int>(neurons));
  if (spec.hidden.empty())
    table.fail("hidden", "[], needs at least one hidden layer, as [6]");
  require_inputs_for_penalty(table, spec, inputs);
  return spec;
}

void require_channels(const ConfigTable& root, const std::vector<Input>& inputs,
                      const std::string& kind) {
  require_temperature_first(root, inputs, kind);
  for (const Input& input : inputs)
    if (input.kind != InputKind::kColumn)
      root.fail("inputs",
                fmt::format("\"{}\"; a {} takes what a soak shows: "
                            "\"quadrature\", \"drive_voltage\" or "
                            "\"drive_frequency\" beside the temperature",
                            input_name(input), kind));
}

AdaptedSpec read_adapted(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  AdaptedSpec spec;
  const ConfigTable table = root.table_or_empty("adapted");
  spec.noise.bias =
      table.number_or("noise_deg_per_s", spec.noise.bias, positive());
  spec.noise.channel_share = table.number_or(
      "channel_noise_share", spec.noise.channel_share, positive());
  const std::string name = root.text("population");
  const std::filesystem::path file = document.path().parent_path() / name;
  Compensator compensator;
  try {
    compensator = read_compensator(file);
  } catch (const std::invalid_argument& error) {
    root.fail("population", error.what());
  }
  if (!compensator.population)
    root.fail("population",
              fmt::format("\"{}\" is a compensator without a population; "
                          "train one of kind \"population\"",
                          name));
  spec.population = std::move(*compensator.population);
  spec.source =
      fmt::format("{}, {} devices, sha256 {}", file.filename().string(),
                  spec.population.devices, sha256_of_file(file));
  return spec;
}

// The temperature and the population's channels, or some of them.
std::vector<Input> adapted_inputs(const ConfigTable& root,
                                  const Population& population) {
  std::vector<Input> all = {parse_input("temperature")};
  all.insert(all.end(), population.channels.begin(), population.channels.end());
  if (!root.has("inputs")) return all;
  const std::vector<Input> inputs = read_inputs(root);
  require_channels(root, inputs, "adapted");
  for (const Input& input : inputs)
    if (std::find(all.begin(), all.end(), input) == all.end())
      root.fail("inputs", fmt::format("\"{}\"; the population knows {}",
                                      input_name(input),
                                      fmt::join(input_names(all), ", ")));
  return inputs;
}

FitSpec read_kind(const ConfigTable& root, const std::string& kind,
                  const std::vector<Input>& inputs) {
  const auto table = [&] { return root.table_or_empty(kind); };
  if (kind == "none") return NoneSpec{};
  if (kind == "constant") return ConstantSpec{};
  if (kind == "bp") return read_bp(root.table("bp"), inputs);
  if (kind == "polynomial") {
    require_temperature_first(root, inputs, kind);
    return read_polynomial(table());
  }
  if (kind == "fuzzy") {
    require_temperature_first(root, inputs, kind);
    return FuzzySpec{static_cast<int>(table().integer_or("rules", 8, 2, 1000))};
  }
  if (kind == "population") {
    require_channels(root, inputs, kind);
    return PopulationSpec{table().number_or("grid_K", 5.0, positive())};
  }
  require_one_temperature(root, inputs, kind);
  if (kind == "table")
    return TableSpec{table().number_or("bin_width_K", 5.0, positive())};
  if (kind == "spline") return read_spline(table());
  if (kind == "thermistor")
    return ThermistorSpec{table().number_or("b_K", 3950.0, positive())};
  if (kind == "px4") return Px4Spec{};
  return ArduPilotSpec{
      static_cast<int>(table().integer_or("least_samples", 100, 1, 1000000))};
}

// Layers of "bp(2,8)"; nothing when it is not of that form.
std::vector<int> layers_of(std::string_view name) {
  if (!name.starts_with("bp(") || !name.ends_with(')')) return {};
  std::vector<int> layers;
  const char* at = name.data() + 3;
  const char* end = name.data() + name.size() - 1;
  while (at < end) {
    int neurons = 0;
    const auto [next, error] = std::from_chars(at, end, neurons);
    if (error != std::errc() || neurons < 1 || neurons > 1000 ||
        (next != end && *next != ','))
      return {};
    layers.push_back(neurons);
    at = next + 1;
  }
  if (!layers.empty() && end[-1] == ',') return {};
  return layers;
}

FitSpec curve_of(const std::string& name, const ConfigTable& automatic) {
  if (name == "none") return NoneSpec{};
  if (name == "constant") return ConstantSpec{};
  if (name == "linear") return PolynomialSpec{1};
  if (name == "cubic" || name == "cubic_and_slopes") return PolynomialSpec{3};
  if (name == "fifth") return PolynomialSpec{5};
  if (name == "table") return TableSpec{};
  if (name == "spline") return SplineSpec{};
  if (name == "thermistor") return ThermistorSpec{};
  if (name == "fuzzy") return FuzzySpec{};
  const std::vector<std::string> known = {
      "none",  "constant", "linear", "cubic",      "cubic_and_slopes",
      "fifth", "table",    "spline", "thermistor", "fuzzy",
      "bp(6)"};
  const std::string near = suggestion(name, known);
  automatic.fail("candidates",
                 fmt::format("\"{}\"{}; candidates are {}, with the layers of "
                             "a network in brackets, as bp(2,8)",
                             name,
                             near.empty() ? ""
                                          : fmt::format(", did you mean "
                                                        "\"{}\"?",
                                                        near),
                             fmt::join(known, ", ")));
}

std::vector<std::string> usual_candidates(std::size_t inputs) {
  if (inputs == 1)
    return {"none", "constant", "linear", "cubic", "spline", "bp(3)", "bp(6)"};
  return {"none",   "constant", "linear", "cubic", "cubic_and_slopes",
          "spline", "bp(2,4)",  "bp(2,8)"};
}

std::vector<Candidate> read_candidates(const ConfigTable& root,
                                       const std::vector<Input>& inputs) {
  require_temperature_first(root, inputs, "automatic choice");
  const ConfigTable automatic = root.table_or_empty("auto");
  const ConfigTable network_table = root.table_or_empty("bp");
  const BpSpec options = read_bp_options(network_table);
  require_inputs_for_penalty(network_table, options, inputs);
  const std::vector<std::string> names = automatic.has("candidates")
                                             ? automatic.texts("candidates")
                                             : usual_candidates(inputs.size());
  if (names.empty())
    automatic.fail("candidates", "[], needs at least one candidate");
  std::vector<Candidate> candidates;
  for (const std::string& name : names) {
    BpSpec network = options;
    network.hidden = layers_of(name);
    if (!network.hidden.empty())
      candidates.push_back({name, inputs, network});
    else if (const FitSpec curve = curve_of(name, automatic);
             name == "cubic_and_slopes")
      candidates.push_back({name, inputs, curve});
    else
      candidates.push_back({name, {inputs[0]}, curve});
  }
  return candidates;
}

}  // namespace

ModelSpec read_model(const std::filesystem::path& file) {
  return read_model(ConfigDocument::read(file));
}

ModelSpec read_model(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  ModelSpec spec;
  spec.text = document.text();
  spec.files = {document.path()};
  const std::string kind = root.choice("kind", kKinds);
  spec.rows = read_rows(root.table_or_empty("rows"), kind);
  if (kind == "adapted") {
    AdaptedSpec adapted = read_adapted(document);
    spec.files.push_back(document.path().parent_path() /
                         root.text("population"));
    spec.inputs = adapted_inputs(root, adapted.population);
    spec.kind = std::move(adapted);
  } else {
    const bool needs_inputs = kind == "bp" || kind == "auto";
    spec.inputs = needs_inputs || root.has("inputs")
                      ? read_inputs(root)
                      : std::vector<Input>{parse_input("temperature")};
    if (kind == "auto")
      spec.candidates = read_candidates(root, spec.inputs);
    else
      spec.kind = read_kind(root, kind, spec.inputs);
  }
  if (const auto table = root.optional_table("scale_factor"))
    spec.scale_factor_bin_K = table->number_or("bin_width_K", 10.0, positive());
  document.reject_unknown_keys();
  return spec;
}

}  // namespace beamgyro
