// SPDX-License-Identifier: MIT
#include "compensation/compensator/compensator_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "dataset/files/atomic_file.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::compensator_file_test {
namespace {

std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> result;
  for (const double value : values)
    result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

std::string error_of(const std::string& text) {
  return rejection([&] { parse_compensator(text, "mine.json"); });
}

Recording with_loop_signals(Recording recording) {
  for (const char* name : {"drive_frequency", "drive_voltage", "quadrature"}) {
    Column column = recording.columns.front();
    column.name = name;
    column.role = Role::kMeasured;
    recording.columns.push_back(column);
  }
  return recording;
}

// The text of a good file with the first `from` replaced.
std::string with(const std::string& from, const std::string& to,
                 const FittedCompensator& c = network_compensator()) {
  std::string text = compensator_text(c);
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(CompensatorFile, LoadedCompensatorAnswersWithTheSameBits) {
  RecordedRun run{.duration = 500.0, .step = 0.37};
  run.temperature = [](double t) { return 20.0 + 15.0 * std::sin(0.01 * t); };
  run.bias = [](double t) { return std::cos(0.003 * t); };
  run.powered = [](double t) { return t < 200.0 || t > 230.0; };
  const Recording recording = with_loop_signals(run.recording());
  for (const auto& [name, c] : one_of_each_kind()) {
    SCOPED_TRACE(name);
    const FittedCompensator loaded =
        parse_compensator(compensator_text(c), "mine.json");
    EXPECT_EQ(kind_name(loaded.bias), kind_name(c.bias));
    EXPECT_EQ(loaded.inputs, c.inputs);
    EXPECT_EQ(loaded.temperature_range, c.temperature_range);
    EXPECT_EQ(loaded.provenance, c.provenance);
    EXPECT_EQ(bits(compensated_rate(loaded, recording)),
              bits(compensated_rate(c, recording)));
    EXPECT_EQ(bits(baseline_rate(loaded, recording)),
              bits(baseline_rate(c, recording)));
    EXPECT_EQ(compensator_text(loaded), compensator_text(c));
  }
}

TEST(CompensatorFile, IsWrittenAndReadThroughAFile) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "compensator_file_test.json";
  write_text_file(file, compensator_text(network_compensator()));
  EXPECT_EQ(compensator_text(read_compensator(file)),
            compensator_text(network_compensator()));
  std::filesystem::remove(file);
  EXPECT_TRUE(holds(rejection([&] { read_compensator(file); }),
                    "compensator_file_test.json"));
}

TEST(CompensatorFile, AnyCutOffFileIsRejectedWithLineAndColumn) {
  for (const auto& [name, c] : one_of_each_kind()) {
    const std::string text = compensator_text(c);
    const std::size_t step = name == "bp" ? 7 : 97;
    // The last newline and brace: without the newline alone it is still whole.
    for (std::size_t size = 0; size + 2 <= text.size(); size += step) {
      const std::string message = error_of(text.substr(0, size));
      ASSERT_TRUE(holds(message, "mine.json: not a whole JSON file"))
          << name << " " << size;
      ASSERT_TRUE(holds(message, "line "));
    }
  }
}

TEST(CompensatorFile, WrongTypeIsNamed) {
  EXPECT_EQ(error_of("{}"), "mine.json: \"filetype\" is missing");
  EXPECT_TRUE(holds(error_of("[1]"), "must be an object"));
}

TEST(CompensatorFile, ParameterThatIsNotFiniteIsNotWritten) {
  FittedCompensator c = spline_compensator();
  c.bias.function = Polynomial{{1.0, std::nan("")}};
  EXPECT_THROW(compensator_text(c), std::runtime_error);
}

const FittedCompensator& sample(const std::string& name) {
  static const std::vector<NamedCompensator> all = one_of_each_kind();
  for (const NamedCompensator& each : all)
    if (each.name == name) return each.compensator;
  throw std::logic_error(name);
}

struct Damage {
  const char* sample;
  const char* from;
  const char* to;
  const char* message;
};

const Damage kDamages[] = {
    {"constant", "value_deg_per_s", "value",
     "parameters: \"value_deg_per_s\" is missing"},
    {"polynomial_with_slopes", "\"slopes\": [\n   0.25\n  ]", "\"slopes\": []",
     "parameters.slopes: 0 slopes, must be one for each of the 2 inputs but "
     "the first"},
    {"polynomial", "\"coefficients\": [\n   0.1,",
     "\"coefficients\": [\n   \"0.1\",", "parameters.coefficients[0]"},
    {"table", "\"temperatures_degC\": [\n   -40.0",
     "\"temperatures_degC\": [\n   -35.0", "temperatures_degC: must increase"},
    {"table", "\"values_deg_per_s\": [", "\"values_deg_per_s\": [ 1.0,",
     "20 values for 19 temperatures"},
    {"thermistor", "\"series\": ", "\"series\": -", "parameters.series"},
    {"thermistor", "\"b_K\": 3950.0", "\"b_K\": 0",
     "parameters.b_K: 0, must be above 0"},
    {"thermistor", "gain_deg_per_s", "gain", "\"gain_deg_per_s\" is missing"},
    {"fuzzy", "\"width\": 0.25", "\"width\": 0",
     "parameters.width: 0, must be above 0"},
    {"fuzzy", "\"centres\": [", "\"centres\": [ -2.0,",
     "consequents: 5 rules, must be one for each of the 6"},
    {"fuzzy", "\"consequents\": [\n   [", "\"consequents\": [\n   [ 0.5,",
     "consequents[0]: 4 numbers, must be 3"},
    {"fuzzy", "\"kind\": \"fuzzy\"", "\"kind\": \"table\"",
     "2 inputs, a table takes one"},
    {"radial_basis", "\"width\": 0.6", "\"width\": -1",
     "parameters.width: -1, must be above 0"},
    {"radial_basis", "\"plane\": [", "\"plane\": [ 0.5,",
     "plane: 4 numbers, must be 3"},
    {"radial_basis", "\"weights\": [", "\"weights\": [ 0.5,",
     "weights: 4 weights, must be one for each of the 3 centres"},
    {"resonances", "\"position\": [", "\"position\": [ 0.5,",
     "position: 3 numbers, must be 2, one for each input but the last"},
    {"resonances", "\"widths\": [\n   0.2", "\"widths\": [\n   -0.2",
     "parameters.widths: must be above 0"},
    {"resonances", "\"bias_heights_deg_per_s\": [",
     "\"bias_heights_deg_per_s\": [ 0.5,",
     "3 numbers, must be 2, one for each of the places"},
    {"resonances", "\"position_sigma\": 0.05", "\"position_sigma\": 0",
     "parameters.position_sigma: 0, must be above 0"},
    {"bp_with_every_input", "\"values\": [\n   0.98", "\"values\": [\n   -0.98",
     "scale_factor.values: must be above 0"},
    {"bp_with_every_input", "\"values\": [", "\"values\": [ 1.0,",
     "8 values for 7 temperatures"},
    {"none", "\"method\"", "\"methods\"", "training: \"method\" is missing"},
    {"none", "\"choices\": [", "\"choices\": [ 3,", "training.choices[0]"},
    {"none", "\"by\"", "\"bye\"",
     "training.cross_validation: \"by\" is missing"},
    {"none", "\"constant_in_sample_rms_deg_per_s\": 1.5",
     "\"constant_in_sample_rms_deg_per_s\": null",
     "training.constant_in_sample_rms_deg_per_s"},
    {"none", "\"format_version\": 2", "\"format_version\": 1",
     "written by an older program; this one reads version 2"},
    {"bp", "beamgyro-compensator", "beamgyro-recording",
     "mine.json: filetype: \"beamgyro-recording\", must be"},
    {"bp", "\"format_version\": 2", "\"format_version\": 3",
     "written by a newer program"},
    {"bp", "\"kind\": \"bp\"", "\"kind\": \"rbf\"", "kind: \"rbf\", must be"},
    {"bp", "temperature_lowpass(0.1)", "true_bias",
     "inputs[1]: input \"true_bias\""},
    {"bp", "20.1", "null",
     "input_scales[0].centre: null, must be a finite number"},
    {"bp", "20.1", "1e999", "mine.json"},
    {"bp", "20.1", "NaN", "line "},
    {"bp", "\"half_width\": 3.3", "\"half_width\": 0",
     "input_scales[0].half_width: 0, must be positive"},
    {"bp", "\"weights\"", "\"weighs\"", "parameters: \"weights\" is missing"},
    {"bp", "\"weights\": [", "\"weights\": [ 0.5,",
     "parameters.weights: bp network: 58 weights, its layers need 57"},
    {"spline", "\"knots_degC\": [", "\"knots_degC\": [ -50.0,",
     "15 knots, 14 values"},
    {"spline", "\"knots_degC\": [\n   -40.0", "\"knots_degC\": [\n   40.0",
     "knots_degC: must increase"},
    {"bp", "50.7", "-50.7", "[lowest, highest]"}};

TEST(CompensatorFile, DamageOfEachKindIsNamedByItsKey) {
  for (const auto& [name, from, to, part] : kDamages) {
    SCOPED_TRACE(name);
    const std::string message = error_of(with(from, to, sample(name)));
    EXPECT_TRUE(holds(message, "mine.json"));
    EXPECT_TRUE(holds(message, part));
  }
}

TEST(CompensatorFile, NestingThatOverflowsTheStackIsRejected) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_TRUE(holds(error_of("{\"filetype\": " + deep + "}"),
                    "mine.json: arrays and objects nest deeper than 64"));
  std::string keys = "{\"filetype\": 1";
  for (int i = 0; i < 200000; ++i) keys += ",\"" + std::to_string(i) + "\":1";
  EXPECT_TRUE(
      holds(error_of(keys + "}"), "an object of more than 1000 members"));
}

TEST(CompensatorFile, FilesLargerThanACompensatorAreNotRead) {
  const TestDirectory made;
  const std::filesystem::path file = made.directory / "large.json";
  write_text_file(file, "{}");
  std::filesystem::resize_file(file, std::uintmax_t{50} << 30);
  const std::string message = rejection([&] { read_compensator(file); });
  EXPECT_TRUE(holds(message, "53687091200 bytes; expected a compensator"));
}

}  // namespace
}  // namespace beamgyro::internal::compensator_file_test
