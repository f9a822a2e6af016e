// SPDX-License-Identifier: MIT
#include "compensation/model_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/compensation/message_of.h"

namespace beamgyro {
namespace {

ModelSpec parse(const std::string& text) {
  return read_model(ConfigDocument::parse(text, "model.toml"));
}

std::string error_of(const std::string& text) {
  return message_of([&] { parse(text); });
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

TEST(ModelFile, LbfgsTakesWeightDecayAndMoreEpochs) {
  const std::string text =
      "kind = \"bp\"\ninputs = [\"temperature\"]\n"
      "[bp]\nhidden = [6]\ntrainer = \"lbfgs\"\nweight_decay = 1e-6\n";
  const TrainOptions training = std::get<BpSpec>(parse(text).kind).training;
  EXPECT_EQ(training.trainer, Trainer::kLbfgs);
  EXPECT_EQ(std::get<BpSpec>(parse(text).kind).weight_decays,
            (std::vector<double>{1e-6}));
  EXPECT_EQ(training.max_epochs, kLbfgsMaxEpochs);
  EXPECT_EQ(training.patience, kLbfgsPatience);
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

TEST(ModelFile, WrongFilesAreAnsweredWithPlaceAndCure) {
  const std::string bp = "kind = \"bp\"\ninputs = [\"temperature\"]\n[bp]\n";
  for (const Wrong& wrong : {
           Wrong{"inputs = [\"temperature\"]\n", "kind"},
           Wrong{"kind = \"splin\"\ninputs = [\"temperature\"]\n", "spline"},
           Wrong{"kind = \"polynomial\"\ninputs = []\n", "at least one input"},
           Wrong{"kind = \"polynomial\"\ninputs = [\"temprature\"]\n",
                 "did you mean \"temperature\""},
           Wrong{"kind = \"polynomial\"\n"
                 "inputs = [\"temperature\", \"output\"]\n",
                 "feels the rate"},
           Wrong{"kind = \"spline\"\ninputs = [\"output\"]\n",
                 "a spline takes one input"},
           Wrong{"kind = \"spline\"\ninputs = [\"temperature\"]\n"
                 "[spline]\nknot_spacing_K = 0\n",
                 "knot_spacing_K"},
           Wrong{"kind = \"spline\"\ninputs = [\"temperature\"]\n"
                 "[bp]\nhidden = [6]\n",
                 "bp"},
           Wrong{"kind = \"polynomial\"\ninputs = [\"temperature\"]\n"
                 "[polynomial]\ndegree = 13\n",
                 "degree"},
           Wrong{"kind = \"polynomial\"\ninputs = [\"temperature\"]\n"
                 "[rows]\nseconds = nan\n",
                 "seconds"},
       }) {
    const std::string message = error_of(wrong.text);
    EXPECT_NE(message.find("model.toml"), std::string::npos) << message;
    EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
  }
  for (const Wrong& wrong : {
           Wrong{"", "hidden"},
           Wrong{"hidden = []\n", "at least one hidden layer"},
           Wrong{"hidden = [0]\n", "hidden"},
           Wrong{"hidden = [6]\nrestart = 2\n", "restarts"},
           Wrong{"hidden = [6]\nrestarts = 0\n", "restarts"},
           Wrong{"hidden = [6]\nlearning_rate = 0.1\n", "learning_rate"},
           Wrong{"hidden = [6]\ntrainer = \"incremental\"\nmomentum = 1\n",
                 "momentum"},
           Wrong{"hidden = [6]\ntrainer = \"lbfgs\"\nmomentum = 0.5\n",
                 "momentum"},
           Wrong{"hidden = [6]\ntrainer = \"lbfgs\"\nweight_decay = -1\n",
                 "weight_decay"},
           Wrong{"hidden = [6]\ntrainer = \"adam\"\n", "incremental"},
       }) {
    const std::string message = error_of(bp + wrong.text);
    EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
  }
  EXPECT_NE(error_of("kind = \"polynomial\"\n"
                     "inputs = [\"output\", \"output\"]\n")
                .find("\"output\" is there twice"),
            std::string::npos);
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

}  // namespace
}  // namespace beamgyro
