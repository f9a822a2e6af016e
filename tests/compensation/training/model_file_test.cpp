// SPDX-License-Identifier: MIT
#include "compensation/training/model_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "compensation/methods/bias_model.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::model_file_test {
namespace {

ModelSpec parse(const std::string& text) {
  return read_model(ConfigDocument::parse(text, "model.toml"));
}

std::string error_of(const std::string& text) {
  return rejection([&] { parse(text); });
}

TEST(ModelFile, PolynomialHasDegreeThreeUnlessItSaysOtherwise) {
  const std::string text =
      "kind = \"polynomial\"\ninputs = [\"temperature\"]\n";
  const ModelSpec spec = parse(text);
  EXPECT_EQ(std::get<PolynomialSpec>(spec.kind).degree, 3);
  EXPECT_EQ(spec.text, text);
  EXPECT_EQ(spec.rows.seconds, 60.0);
  EXPECT_FALSE(spec.rows.steady_K_per_min.has_value());
  EXPECT_EQ(
      std::get<PolynomialSpec>(parse(text + "[polynomial]\ndegree = 5\n").kind)
          .degree,
      5);
}

TEST(ModelFile, EveryOptionOfANetworkIsRead) {
  const ModelSpec spec = parse(R"toml(kind = "bp"
inputs = ["output", "temperature_lowpass(100)"]
rows = { seconds = 10, steady_K_per_min = 0.05 }
[bp]
hidden = [8, 4]
trainer = "incremental"
restarts = 3
max_epochs = 77
patience = 11
goal_deg_per_s = 0.01
learning_rate = 0.5
momentum = 0.25
)toml");
  EXPECT_EQ(input_names(spec.inputs),
            (std::vector<std::string>{"output", "temperature_lowpass(100)"}));
  EXPECT_EQ(spec.rows.seconds, 10.0);
  EXPECT_EQ(spec.rows.steady_K_per_min, 0.05);
  const BpSpec& bp = std::get<BpSpec>(spec.kind);
  EXPECT_EQ(bp.hidden, (std::vector<int>{8, 4}));
  EXPECT_EQ(bp.goal_deg_per_s, 0.01);
  EXPECT_EQ(bp.training.trainer, Trainer::kIncremental);
  EXPECT_EQ(bp.training.restarts, 3);
  EXPECT_EQ(bp.training.max_epochs, 77);
  EXPECT_EQ(bp.training.patience, 11);
  EXPECT_EQ(bp.training.learning_rate, 0.5);
  EXPECT_EQ(bp.training.momentum, 0.25);
}

TEST(ModelFile, SplineReadsItsSpacingAndEnds) {
  const ModelSpec spec = parse(
      "kind = \"spline\"\ninputs = [\"temperature\"]\n"
      "[spline]\nknot_spacing_K = 7.5\nends = \"natural\"\n");
  EXPECT_EQ(std::get<SplineSpec>(spec.kind).knot_spacing_K, 7.5);
  EXPECT_EQ(std::get<SplineSpec>(spec.kind).end, SplineEnd::kNatural);
}

struct Wrong {
  const char* text;
  const char* message;
};

// What a file says wrongly, and what is answered.
const Wrong kWrong[] = {
    {"inputs = [\"temperature\"]\n", "kind"},
    {"kind = \"splin\"\ninputs = [\"temperature\"]\n", "spline"},
    {"kind = \"polynomial\"\ninputs = []\n", "at least one input"},
    {"kind = \"polynomial\"\ninputs = [\"temprature\"]\n",
     "did you mean \"temperature\""},
    {"kind = \"polynomial\"\ninputs = [\"temperature\", \"output\"]\n",
     "feels the rate"},
    {"kind = \"spline\"\ninputs = [\"output\"]\n", "a spline takes one input"},
    {"kind = \"spline\"\ninputs = [\"temperature\"]\n[spline]\nknot_spacing_K "
     "= 0\n",
     "knot_spacing_K"},
    {"kind = \"spline\"\ninputs = [\"temperature\"]\n[bp]\nhidden = [6]\n",
     "bp"},
    {"kind = \"polynomial\"\ninputs = [\"temperature\"]\n[polynomial]\ndegree "
     "= 13\n",
     "degree"},
    {"kind = \"polynomial\"\ninputs = [\"temperature\"]\n[rows]\nseconds = "
     "nan\n",
     "seconds"},
    {"kind = \"polynomial\"\ninputs = [\"output\", \"output\"]\n",
     "\"output\" is there twice"},
    {"kind = \"px4\"\ninputs = [\"temperature_lowpass(9)\"]\n",
     "a px4 takes one input, \"temperature\""},
    {"kind = \"ardupilot\"\ninputs = [\"rate\"]\n", "a ardupilot takes one"},
    {"kind = \"table\"\ninputs = [\"temperature_rate(9)\"]\n",
     "a table takes one input, \"temperature\" or"},
    {"kind = \"thermistor\"\ninputs = [\"temperature\", \"quadrature\"]\n",
     "2 inputs starting with"},
    {"kind = \"fuzzy\"\ninputs = [\"temperature\", \"rate\"]\n",
     "feels the rate"},
    {"kind = \"fuzzy\"\n[fuzzy]\nrules = 1\n", "rules"},
    {"kind = \"radial_basis\"\n[radial_basis]\nridge = 0\n", "ridge"},
    {"kind = \"radial_basis\"\ninputs = [\"temperature\", \"output\"]\n",
     "feels the rate"},
    {"kind = \"resonances\"\ninputs = [\"temperature\"]\n",
     "\"temperature\"; resonances take"},
    {"kind = \"resonances\"\ninputs = [\"quadrature\"]\n",
     "the first is another"},
    {"kind = \"resonances\"\ninputs = [\"temperature\", \"rate\", "
     "\"quadrature\"]\n",
     "it tells nothing of the beam's temperature"},
    {"kind = \"resonances\"\ninputs = [\"temperature\", \"quadrature\"]\n"
     "[resonances]\nmost = 9\n",
     "most"},
    {"kind = \"resonances\"\ninputs = [\"temperature\", \"quadrature\"]\n"
     "[resonances]\nentries = \"bins\"\n",
     "\"bins\" is not known; expected one of \"soaks\", \"knots\""},
    {"kind = \"resonances\"\ninputs = [\"temperature\", \"quadrature\"]\n"
     "[resonances]\nentries = \"knots\"\nknot_spacing_K = 0\n",
     "knot_spacing_K"},
    {"kind = \"table\"\n[table]\nentries = \"knots\"\n", "entries"},
    {"kind = \"table\"\n[table]\nbin_width_K = 0\n", "bin_width_K"},
    {"kind = \"thermistor\"\n[thermistor]\nb_K = -1\n", "b_K"},
    {"kind = \"ardupilot\"\n[ardupilot]\nleast_samples = 0\n", "least_samples"},
    {"kind = \"none\"\n[scale_factor]\nbin_width_K = 0\n", "bin_width_K"},
    {"kind = \"none\"\n[table]\nbin_width_K = 5\n", "table"},
    {"kind = \"cubic\"\n", "kind"},
    {"kind = \"bp\"\n[bp]\nhidden = [6]\n", "inputs"},
    {"kind = \"px4\"\nrows = { steady_K_per_min = 1 }\n", "seconds is 0"},
    {"kind = \"spline\"\nrows = { lag_min = 7 }\n", "\"adapted\" alone"},
    {"kind = \"spline\"\nrows = { after_power_on_min = -1 }\n",
     "after_power_on_min"},
    {"kind = \"bp\"\ninputs = [\"temperature\"]\n[bp]\nhidden = "
     "[6]\nrate_penalty = 1\n",
     "do not feel the rate"},
    {"kind = \"bp\"\ninputs = [\"output\"]\n[bp]\nhidden = [6]\ntrainer = "
     "\"incremental\"\nrate_penalty = 1\n",
     "rate_penalty"},
    {"kind = \"bp\"\ninputs = [\"output\"]\n[bp]\nhidden = [6]\nweight_decays "
     "= []\n",
     "at least one value"},
    {"kind = \"auto\"\ninputs = [\"temperature\"]\n[bp]\nrate_penalty = 1\n",
     "do not feel the rate"},
    {"kind = \"auto\"\ninputs = [\"temperature\", \"output\"]\n",
     "feels the rate"}};

// In the table of a network.
const Wrong kWrongNetworks[] = {
    {"", "hidden"},
    {"hidden = []\n", "at least one hidden layer"},
    {"hidden = [0]\n", "hidden"},
    {"hidden = [6]\nrestart = 2\n", "restarts"},
    {"hidden = [6]\nrestarts = 0\n", "restarts"},
    {"hidden = [6]\nlearning_rate = 0.1\n", "learning_rate"},
    {"hidden = [6]\ntrainer = \"incremental\"\nmomentum = 1\n", "momentum"},
    {"hidden = [6]\nmomentum = 0.5\n", "momentum"},
    {"hidden = [6]\nweight_decay = -1\n", "weight_decay"},
    {"hidden = [6]\ntrainer = \"adam\"\n", "incremental"}};

TEST(ModelFile, WrongFilesAreAnsweredWithPlaceAndCure) {
  for (const auto& [text, part] : kWrong) {
    const std::string message = error_of(text);
    EXPECT_TRUE(holds(message, "model.toml"));
    EXPECT_TRUE(holds(message, part));
  }
  const std::string bp = "kind = \"bp\"\ninputs = [\"temperature\"]\n[bp]\n";
  for (const auto& [text, part] : kWrongNetworks)
    EXPECT_TRUE(holds(error_of(bp + text), part));
}

TEST(ModelFile, ShippedModelsAreReadAndStartWithASentence) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(PROJECT_SOURCE_DIR) / "scenarios/models")) {
    const ModelSpec spec = read_model(entry.path());
    EXPECT_TRUE(spec.text.starts_with("# ")) << entry.path();
    EXPECT_FALSE(spec.inputs.empty());
    ++count;
  }
  EXPECT_GE(count, 7);
}

template <class Spec>
Spec spec_of(const std::string& text) {
  return std::get<Spec>(parse(text).kind);
}

TEST(ModelFile, EveryKindHasItsDefaultsAndTheTemperatureForInput) {
  for (const char* kind :
       {"none", "constant", "polynomial", "table", "spline", "px4", "ardupilot",
        "thermistor", "fuzzy", "radial_basis"}) {
    const ModelSpec spec = parse(fmt::format("kind = \"{}\"\n", kind));
    EXPECT_EQ(input_names(spec.inputs),
              (std::vector<std::string>{"temperature"}));
    // The autopilots' fits take samples, all others rows of a minute.
    const std::string name = kind;
    EXPECT_EQ(spec.rows.seconds,
              name == "px4" || name == "ardupilot" ? 0.0 : 60.0)
        << kind;
    EXPECT_TRUE(spec.candidates.empty());
    EXPECT_FALSE(spec.scale_factor_bin_K.has_value());
  }
  EXPECT_EQ(method_name(parse("kind = \"none\"\n").kind), "none");
  EXPECT_EQ(method_name(parse("kind = \"constant\"\n").kind), "constant");
  EXPECT_EQ(method_name(parse("kind = \"px4\"\n").kind),
            "cubic as PX4 fits it");
  EXPECT_TRUE(spec_of<PolynomialSpec>("kind = \"polynomial\"\n").normalised);
  EXPECT_EQ(spec_of<TableSpec>("kind = \"table\"\n").bin_width_K, 5.0);
  EXPECT_EQ(spec_of<ArduPilotSpec>("kind = \"ardupilot\"\n").least_samples,
            100);
  EXPECT_EQ(spec_of<ThermistorSpec>("kind = \"thermistor\"\n").b_K, 3950.0);
  EXPECT_EQ(spec_of<FuzzySpec>("kind = \"fuzzy\"\n").rules, 8);
  const std::string basis = "kind = \"radial_basis\"\n";
  EXPECT_EQ(spec_of<RadialBasisSpec>(basis).centres, 8);
  EXPECT_EQ(
      spec_of<RadialBasisSpec>(basis + "[radial_basis]\nwidth_share = 2\n")
          .width_share,
      2.0);
}

TEST(ModelFile, EveryKeyOfEveryKindIsRead) {
  const auto polynomial = spec_of<PolynomialSpec>(
      "kind = \"polynomial\"\n[polynomial]\ndegree = 5\nnormalised = false\n");
  EXPECT_EQ(polynomial.degree, 5);
  EXPECT_FALSE(polynomial.normalised);
  EXPECT_EQ(method_name(polynomial), "polynomial of degree 5, not normalised");
  EXPECT_EQ(spec_of<TableSpec>("kind = \"table\"\n[table]\nbin_width_K = 2.5\n")
                .bin_width_K,
            2.5);
  EXPECT_EQ(spec_of<ArduPilotSpec>(
                "kind = \"ardupilot\"\n[ardupilot]\nleast_samples = 7\n")
                .least_samples,
            7);
  EXPECT_EQ(spec_of<ThermistorSpec>(
                "kind = \"thermistor\"\n[thermistor]\nb_K = 3435\n")
                .b_K,
            3435.0);
  EXPECT_EQ(spec_of<FuzzySpec>("kind = \"fuzzy\"\n[fuzzy]\nrules = 5\n").rules,
            5);
  EXPECT_EQ(parse("kind = \"none\"\n[scale_factor]\n").scale_factor_bin_K,
            10.0);
  EXPECT_EQ(parse("kind = \"none\"\n[scale_factor]\nbin_width_K = 4\n")
                .scale_factor_bin_K,
            4.0);
}

TEST(ModelFile, ANetworkChoosesAmongWeightDecaysUnlessToldOne) {
  const std::string bp =
      "kind = \"bp\"\ninputs = [\"output\"]\n[bp]\nhidden = [6]\n";
  EXPECT_EQ(spec_of<BpSpec>(bp).weight_decays,
            (std::vector<double>{0.0, 1e-8, 1e-6}));
  EXPECT_EQ(spec_of<BpSpec>(bp + "weight_decay = 1e-4\n").weight_decays,
            (std::vector<double>{1e-4}));
  EXPECT_EQ(spec_of<BpSpec>(bp + "weight_decays = [1e-3, 0]\n").weight_decays,
            (std::vector<double>{1e-3, 0.0}));
  EXPECT_EQ(spec_of<BpSpec>(bp).training.rate_penalty, 0.0);
  EXPECT_EQ(spec_of<BpSpec>(bp + "rate_penalty = 25\n").training.rate_penalty,
            25.0);
  EXPECT_EQ(spec_of<BpSpec>(bp + "trainer = \"incremental\"\n").weight_decays,
            (std::vector<double>{0.0}));
}

std::vector<std::string> candidate_names(const ModelSpec& spec) {
  std::vector<std::string> names;
  for (const Candidate& candidate : spec.candidates)
    names.push_back(candidate.name);
  return names;
}

TEST(ModelFile, AutomaticChoiceNamesItsCandidates) {
  const ModelSpec spec = parse(R"toml(kind = "auto"
inputs = ["temperature", "temperature_rate(60)"]
[auto]
candidates = ["constant", "linear", "cubic", "cubic_and_slopes", "fifth",
              "table", "spline", "thermistor", "fuzzy", "radial_basis", "bp(2,8)",
              "cubic + temperature_play(3)"]
[bp]
restarts = 2
)toml");
  ASSERT_EQ(spec.candidates.size(), 12u);
  EXPECT_EQ(candidate_names(spec)[10], "bp(2,8)");
  const BpSpec& network = std::get<BpSpec>(spec.candidates[10].kind);
  EXPECT_EQ(network.hidden, (std::vector<int>{2, 8}));
  EXPECT_EQ(network.training.restarts, 2);
  EXPECT_EQ(std::get<PolynomialSpec>(spec.candidates[1].kind).degree, 1);
  EXPECT_EQ(std::get<PolynomialSpec>(spec.candidates[4].kind).degree, 5);
  // Curves take the temperature alone, a cubic with an input that one, too.
  const Candidate& with_play = spec.candidates[11];
  EXPECT_EQ(with_play.inputs,
            (std::vector<Input>{parse_input("temperature"),
                                parse_input("temperature_play(3)")}));
  EXPECT_EQ(std::get<PolynomialSpec>(with_play.kind).degree, 3);
  for (std::size_t k = 0; k < 11; ++k) {
    const Candidate& candidate = spec.candidates[k];
    EXPECT_EQ(candidate.inputs.size(), candidate.name == "cubic_and_slopes" ||
                                               candidate.name == "bp(2,8)"
                                           ? 2u
                                           : 1u)
        << candidate.name;
  }
  // Rows have the inputs of all.
  EXPECT_EQ(input_names(spec.inputs),
            (std::vector<std::string>{"temperature", "temperature_rate(60)",
                                      "temperature_play(3)"}));
}

TEST(ModelFile, AutomaticChoiceHasUsualCandidates) {
  EXPECT_EQ(
      candidate_names(parse("kind = \"auto\"\ninputs = [\"temperature\"]\n")),
      (std::vector<std::string>{"none", "constant", "linear", "cubic",
                                "cubic + temperature_lowpass(100)",
                                "cubic + temperature_play(2)", "spline",
                                "table", "bp(3)", "bp(6)"}));
  EXPECT_EQ(
      candidate_names(
          parse("kind = \"auto\"\ninputs = [\"temperature\","
                " \"temperature_lowpass(30)\", \"temperature_lowpass(400)\","
                " \"quadrature\"]\n")),
      (std::vector<std::string>{
          "none", "constant", "linear", "cubic",
          "cubic + temperature_lowpass(30)", "cubic + temperature_lowpass(400)",
          "cubic + temperature_play(2)", "cubic_and_slopes", "spline", "table",
          "bp(2,4)", "bp(2,8)"}));
}

TEST(ModelFile, CandidatesThatAreNoneAreRefused) {
  for (const char* name :
       {"bp()", "bp(2,)", "bp(2, 8)", "bp(0)", "bp(-3)", "bp(2.5)", "bp(1001)",
        "bp(6", "bp", "qubic", "", "cubic + rate", "cubic + temperature",
        "cubic + ", "cubic + play(2)", "cubic+quadrature"}) {
    const std::string message =
        error_of(fmt::format("kind = \"auto\"\ninputs = [\"temperature\"]\n"
                             "[auto]\ncandidates = [\"{}\"]\n",
                             name));
    EXPECT_TRUE(holds(message, "candidates are none, constant"))
        << name << ": " << message;
  }
  EXPECT_TRUE(holds(error_of("kind = \"auto\"\ninputs = [\"temperature\"]\n"
                             "[auto]\ncandidates = [\"qubic\"]\n"),
                    "did you mean \"cubic\"?"));
  EXPECT_TRUE(holds(error_of("kind = \"auto\"\ninputs = [\"temperature\"]\n"
                             "[auto]\ncandidates = []\n"),
                    "at least one candidate"));
}

}  // namespace
}  // namespace beamgyro::internal::model_file_test
