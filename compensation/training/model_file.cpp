// SPDX-License-Identifier: MIT
#include "compensation/training/model_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <type_traits>

#include "compensation/compensator/compensator_file.h"
#include "compensation/methods/method_inputs.h"
#include "config/suggestion.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kAutomatic = "auto";

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for_each_alternative<FitSpec>(
      [&]<class Method>() { names.push_back(Method::kName); });
  names.insert(names.end() - 2, kAutomatic);
  return names;
}

// Calls `use` for the method of that name; whether there is one.
template <class Use>
bool with_method(const std::string& name, const Use& use) {
  bool found = false;
  for_each_alternative<FitSpec>([&]<class Method>() {
    if (name != Method::kName) return;
    found = true;
    use.template operator()<Method>();
  });
  return found;
}

bool fits_samples(const std::string& kind) {
  bool samples = false;
  with_method(kind, [&]<class Method>() {
    samples = requires { Method::kFitsSamples; };
  });
  return samples;
}

RowOptions read_rows(const ConfigTable& table, const std::string& kind) {
  RowOptions rows;
  rows.seconds = table.number_or(
      "seconds", fits_samples(kind) ? 0.0 : rows.seconds, non_negative());
  rows.steady_K_per_min = table.optional_number("steady_K_per_min", positive());
  if (rows.steady_K_per_min && rows.seconds == 0.0)
    table.fail("steady_K_per_min",
               "is the slope over the seconds of a row, and seconds is 0");
  rows.lag_min = table.number_or("lag_min", 0.0, non_negative());
  if (rows.lag_min > 0.0 && rows.seconds == 0.0)
    table.fail("lag_min",
               "needs the slope over the seconds of a row, and "
               "seconds is 0");
  if (table.has("lag_min") && kind != AdaptedSpec::kName)
    table.fail("lag_min", "is for the kind \"adapted\" alone");
  rows.after_power_on_min =
      table.number_or("after_power_on_min", 0.0, non_negative());
  return rows;
}

std::vector<Input> named_inputs(const ConfigTable& root, bool needed) {
  if (needed || root.has("inputs")) return read_inputs(root);
  return {parse_input("temperature")};
}

template <class Method>
Method read_method(MethodSource& source) {
  constexpr InputRule kRule = Method::kInputRule;
  if (kRule != InputRule::kOfItsOwn)
    source.inputs = named_inputs(source.root(), kRule == InputRule::kNamed);
  check_inputs(source.root(), source.inputs, kRule, Method::kName);
  return Method::read(source);
}

Population population_of(const std::filesystem::path& file) {
  FittedCompensator compensator = read_compensator(file);
  if (!compensator.population)
    throw std::invalid_argument(fmt::format(
        "{}: is a compensator without a population; train one of kind "
        "\"population\"",
        file.string()));
  return std::move(*compensator.population);
}

// Layers of "bp(2,8)"; nothing when it is not of that form.
std::vector<int> named_layers(std::string_view name) {
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

// The curves that candidates name besides the methods in their defaults.
struct NamedCurve {
  const char* name;
  PolynomialSpec curve;
  bool all_inputs = false;  // or the first alone
};
const NamedCurve kNamedCurves[] = {{"linear", {1}},
                                   {"cubic", {3}},
                                   {"cubic_and_slopes", {3}, true},
                                   {"fifth", {5}}};

// A cubic with one further input, as "cubic + temperature_play(2)".
constexpr std::string_view kCubicAnd = "cubic + ";

std::string cubic_and(const Input& input) {
  return std::string(kCubicAnd) + input_name(input);
}

std::vector<std::string> candidate_names() {
  std::vector<std::string> names;
  for_each_alternative<FitSpec>([&]<class Method>() {
    if constexpr (requires { Method::kIsCandidate; })
      names.emplace_back(Method::kName);
    if constexpr (std::is_same_v<Method, PolynomialSpec>)
      for (const NamedCurve& curve : kNamedCurves)
        names.emplace_back(curve.name);
  });
  names.push_back(std::string(kCubicAnd) + "INPUT");
  names.push_back("bp(6)");
  return names;
}

// The further input of a cubic; nothing for a name that means none.
std::optional<Input> further_input(std::string_view name) try {
  if (!name.starts_with(kCubicAnd)) return std::nullopt;
  const Input input = parse_input(name.substr(kCubicAnd.size()));
  const bool is_temperature =
      input.kind == InputKind::kColumn && input.column == "temperature";
  return is_temperature || sees_the_rate(input) ? std::nullopt
                                                : std::optional(input);
} catch (const std::invalid_argument&) {
  return std::nullopt;
}

// A candidate that is no network; nothing for a name that means none.
std::optional<Candidate> candidate_curve(const std::string& name,
                                         const std::vector<Input>& inputs) {
  for (const auto& [known, curve, all_inputs] : kNamedCurves)
    if (name == known)
      return Candidate{
          name, all_inputs ? inputs : std::vector<Input>{inputs[0]}, curve};
  if (const std::optional<Input> further = further_input(name))
    return Candidate{name, {inputs[0], *further}, PolynomialSpec{3}};
  std::optional<Candidate> candidate;
  with_method(name, [&]<class Method>() {
    if constexpr (requires { Method::kIsCandidate; })
      candidate = Candidate{name, {inputs[0]}, Method{}};
  });
  return candidate;
}

[[noreturn]] void reject_candidate(const ConfigTable& automatic,
                                   const std::string& name) {
  const std::vector<std::string> known = candidate_names();
  const std::string near = suggestion(name, known);
  automatic.fail(
      "candidates",
      fmt::format(
          "\"{}\"{}; candidates are {}, with the layers of a network "
          "in brackets, as bp(2,8)",
          name, near.empty() ? "" : fmt::format(", did you mean \"{}\"?", near),
          fmt::join(known, ", ")));
}

// Names of cubics with one of the inputs of a kind, or else with `usual`.
void add_cubics(const std::vector<Input>& inputs, InputKind kind,
                const char* usual, std::vector<std::string>& names) {
  const std::size_t before = names.size();
  for (const Input& input : inputs)
    if (input.kind == kind && input.column == "temperature")
      names.push_back(cubic_and(input));
  if (names.size() == before) names.push_back(cubic_and(parse_input(usual)));
}

std::vector<std::string> usual_candidates(const std::vector<Input>& inputs) {
  std::vector<std::string> names = {"none", "constant", "linear", "cubic"};
  add_cubics(inputs, InputKind::kLowpass, "temperature_lowpass(100)", names);
  add_cubics(inputs, InputKind::kTemperaturePlay, "temperature_play(2)", names);
  const bool is_one = inputs.size() == 1;
  if (!is_one) names.emplace_back("cubic_and_slopes");
  for (const char* name : {"spline", "table", is_one ? "bp(3)" : "bp(2,4)",
                           is_one ? "bp(6)" : "bp(2,8)"})
    names.emplace_back(name);
  return names;
}

// The inputs named, then those that candidates add.
std::vector<Input> inputs_of(std::vector<Input> inputs,
                             const std::vector<Candidate>& candidates) {
  for (const Candidate& candidate : candidates)
    for (const Input& input : candidate.inputs)
      if (std::ranges::find(inputs, input) == inputs.end())
        inputs.push_back(input);
  return inputs;
}

std::vector<Candidate> read_candidates(const MethodSource& source) {
  const std::vector<Input>& inputs = source.inputs;
  check_inputs(source.root(), inputs, InputRule::kTemperatureFirst,
               "automatic choice");
  const ConfigTable automatic = source.table(kAutomatic);
  const BpSpec options = BpSpec::read_options(source);
  const std::vector<std::string> names = automatic.has("candidates")
                                             ? automatic.texts("candidates")
                                             : usual_candidates(inputs);
  if (names.empty())
    automatic.fail("candidates", "[], needs at least one candidate");
  std::vector<Candidate> candidates;
  for (const std::string& name : names) {
    BpSpec network = options;
    network.hidden = named_layers(name);
    if (!network.hidden.empty())
      candidates.push_back({name, inputs, network});
    else if (std::optional<Candidate> curve = candidate_curve(name, inputs))
      candidates.push_back(std::move(*curve));
    else
      reject_candidate(automatic, name);
  }
  return candidates;
}

}  // namespace

void observe(ModelSpec& spec, const EpochObserver& observer) {
  const auto set_observer = [&](FitSpec& kind) {
    if (auto* network = std::get_if<BpSpec>(&kind))
      network->training.observer = observer;
  };
  set_observer(spec.kind);
  for (Candidate& candidate : spec.candidates) set_observer(candidate.kind);
}

ModelSpec read_model(const std::filesystem::path& file) {
  return read_model(ConfigDocument::read(file));
}

ModelSpec read_model(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  ModelSpec spec;
  spec.text = document.text();
  const std::string kind = root.choice("kind", kinds());
  spec.rows = read_rows(root.table_or_empty("rows"), kind);
  MethodSource source{document, {}, {document.path()}, population_of};
  if (kind == kAutomatic) {
    source.inputs = read_inputs(root);
    spec.candidates = read_candidates(source);
    source.inputs = inputs_of(std::move(source.inputs), spec.candidates);
  } else {
    with_method(
        kind, [&]<class Method>() { spec.kind = read_method<Method>(source); });
  }
  spec.inputs = std::move(source.inputs);
  spec.files = std::move(source.files);
  if (const auto table = root.optional_table("scale_factor"))
    spec.scale_factor_bin_K = table->number_or("bin_width_K", 10.0, positive());
  document.reject_unknown_keys();
  return spec;
}

}  // namespace beamgyro::internal
