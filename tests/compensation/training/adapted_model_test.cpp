// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "compensation/compensator/compensator_file.h"
#include "compensation/training/train.h"
#include "dataset/files/atomic_file.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::adapted_model_test {
namespace {

// Unit k of a population: a parabola and a quadrature that tells its bend.
double bend(int unit) { return 1e-3 * std::sin(2.0 * unit + 1.0); }
double bias_of(int unit, double T) {
  return std::cos(3.0 * unit) + 0.02 * std::sin(unit) * T + bend(unit) * T * T;
}

// Soaks of ten minutes.
TrainingRun unit_run(int unit, const std::vector<double>& temperatures) {
  RecordedRun run{.duration = 600.0 * double(temperatures.size()), .step = 5.0};
  run.temperature = [=](double t) {
    return temperatures[static_cast<std::size_t>(t / 600.0)];
  };
  run.bias = [=](double t) { return bias_of(unit, run.temperature(t)); };
  Recording recording = run.recording();
  std::vector<double> quadrature;
  for (const double t : recording.time)
    quadrature.push_back(50.0 + 3e4 * bend(unit) + 0.1 * run.temperature(t));
  recording.columns.push_back(
      {"quadrature", "degree/s", "quadrature", Role::kMeasured, quadrature});
  const std::string name = "unit" + std::to_string(unit);
  return {name + ".h5", "sha of " + name, recording};
}

std::vector<TrainingRun> units(int first, int count) {
  std::vector<double> sweep;
  for (int T = -40; T <= 50; T += 5) sweep.push_back(T);
  std::vector<TrainingRun> runs;
  for (int k = 0; k < count; ++k) runs.push_back(unit_run(first + k, sweep));
  return runs;
}

ModelSpec population_spec() {
  return {.inputs = {parse_input("temperature"), parse_input("quadrature")},
          .kind = PopulationSpec{}};
}

FittedCompensator population() {
  return train(population_spec(), units(0, 20), units(20, 4), 1).compensator;
}

class AdaptedModel : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
    write_text_file(folder_ / "population.json",
                    compensator_text(population()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  ModelSpec model(const std::string& text) const {
    write_text_file(folder_ / "model.toml", text);
    return read_model(folder_ / "model.toml");
  }

  std::filesystem::path folder_;
};

const char* const kAdapted =
    "kind = \"adapted\"\npopulation = \"population.json\"\n";

TEST(PopulationModel, IsItsMeanAndComesBackFromAFile) {
  const FittedCompensator c = population();
  EXPECT_EQ(kind_name(c.bias), "spline");
  EXPECT_EQ(input_names(c.inputs), std::vector<std::string>{"temperature"});
  EXPECT_EQ(c.temperature_range, (TemperatureRange{-40.0, 50.0}));
  double mean = 0.0;
  for (int unit = 0; unit < 20; ++unit) mean += bias_of(unit, 17.0) / 20.0;
  EXPECT_NEAR(c.bias.predict(Eigen::ArrayXXd::Constant(1, 1, 17.0))(0), mean,
              1e-9);
  const std::string text = compensator_text(c);
  const FittedCompensator again = parse_compensator(text, "c.json");
  EXPECT_EQ(compensator_text(again), text);
  ASSERT_TRUE(again.population.has_value());
  EXPECT_TRUE(again.population->modes == c.population->modes);
  EXPECT_TRUE(again.population->mean == c.population->mean);
  EXPECT_EQ(again.population->devices, 20);
}

TEST_F(AdaptedModel, ThreeSoaksOfAnUnseenUnitTellItsCurve) {
  const ModelSpec spec = model(kAdapted);
  EXPECT_EQ(input_names(spec.inputs),
            (std::vector<std::string>{"temperature", "quadrature"}));
  const TrainResult result =
      train(spec, {unit_run(31, {-33.0, -5.0, 45.0})}, {}, 1);
  const FittedCompensator& c = result.compensator;
  EXPECT_EQ(input_names(c.inputs), std::vector<std::string>{"temperature"});
  EXPECT_EQ(c.temperature_range, (TemperatureRange{-40.0, 50.0}));
  EXPECT_FALSE(c.population.has_value());
  for (double T = -40.0; T <= 50.0; T += 5.0)
    EXPECT_NEAR(c.bias.predict(Eigen::ArrayXXd::Constant(1, 1, T))(0),
                bias_of(31, T), 0.03)
        << T;
  const Provenance& p = c.provenance;
  EXPECT_TRUE(p.choices[0].starts_with(
      "population: population.json, 20 devices, sha256 "))
      << p.choices[0];
  for (const std::string& warning : p.warnings)
    EXPECT_FALSE(holds(warning, "apart"));
  EXPECT_EQ(compensator_text(parse_compensator(compensator_text(c), "c.json")),
            compensator_text(c));
}

// Of many units: a single one may be lucky either way.
TEST_F(AdaptedModel, OneSoakWithAChannelTellsMoreThanWithout) {
  const auto square_error = [&](const std::string& text) {
    const ModelSpec spec = model(text);
    double sum = 0.0;
    for (int unit = 30; unit < 60; ++unit) {
      const FittedCompensator c =
          train(spec, {unit_run(unit, {5.0})}, {}, 1).compensator;
      const double left =
          c.bias.predict(Eigen::ArrayXXd::Constant(1, 1, 50.0))(0) -
          bias_of(unit, 50.0);
      sum += left * left;
    }
    return sum;
  };
  EXPECT_LT(square_error(kAdapted),
            0.5 * square_error(std::string(kAdapted) +
                               "inputs = [\"temperature\"]\n"));
}

TEST_F(AdaptedModel, RefusesWhatIsNoPopulation) {
  const auto message = [&](const std::string& text) {
    return rejection([&] { model(text); });
  };
  const auto says = [&](const std::string& text, const std::string& what) {
    EXPECT_TRUE(holds(message(text), what));
  };
  says("kind = \"adapted\"\n", "population");
  says("kind = \"adapted\"\npopulation = \"none.json\"\n", "none.json");
  says(
      std::string(kAdapted) + "inputs = [\"temperature\", \"drive_voltage\"]\n",
      "the population knows temperature, quadrature");
  says(std::string(kAdapted) + "[adapted]\nnoise_deg_per_s = 0\n",
       "adapted.noise_deg_per_s");
  says(
      "kind = \"population\"\ninputs = [\"temperature\", "
      "\"temperature_lowpass(100)\"]\n",
      "takes what a soak shows");
  FittedCompensator plain = population();
  plain.population.reset();
  write_text_file(folder_ / "population.json", compensator_text(plain));
  says(kAdapted, "is a compensator without a population");
}

TEST_F(AdaptedModel, RefusesADamagedPopulation) {
  std::string text = compensator_text(population());
  const auto at = text.find("\"modes\"");
  text.insert(text.find('[', text.find('[', at) + 1) + 1, "1.0, ");
  EXPECT_TRUE(holds(rejection([&] { parse_compensator(text, "c.json"); }),
                    "c.json: population.modes[0]: 39 numbers, must be 38"));
}

}  // namespace
}  // namespace beamgyro::internal::adapted_model_test
