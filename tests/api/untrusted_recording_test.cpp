// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "include/beamgyro/allan.h"
#include "include/beamgyro/compensator.h"
#include "include/beamgyro/device.h"
#include "include/beamgyro/export.h"
#include "include/beamgyro/simulate.h"
#include "include/beamgyro/train.h"
#include "include/beamgyro/validate.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::untrusted_recording_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

Column& column_named(Recording& recording, const std::string& name) {
  return *std::ranges::find(recording.columns, name, &Column::name);
}

/// A run made by hand, and what is wrong with it.
struct Defect {
  const char* words;  // in the message
  std::function<void(Recording&)> make;
};

class UntrustedRecording : public testing::Test {
 protected:
  const Recording run_ =
      simulate(beamgyro::Scenario::read(kScenarios / "ten_minutes.toml"))
          .recording;
  const beamgyro::Model model_ =
      beamgyro::Model::read(kScenarios / "models/cubic.toml");
};

void expect_refused(const char* words, const std::function<void()>& call) {
  EXPECT_TRUE(holds(rejection(call), words));
}

TEST_F(UntrustedRecording, IsRefusedByEveryCallThatTakesOne) {
  const Compensator trained = train(model_, {{"run", run_}}).compensator;
  const auto user = compensator_of("mine", {}, [](const Recording& seen) {
    return column_values(seen, "rate");
  });
  const std::vector<Defect> defects{
      {"status", [](Recording& run) { run.status.clear(); }},
      {"status", [](Recording& run) { run.status.resize(5); }},
      {"temperature",
       [](Recording& run) {
         column_named(run, "temperature").values.resize(3);
       }},
      {"rate", [](Recording& run) { column_named(run, "rate").values = {}; }},
      {"rate: unit 'rad/s'; expected 'degree/s'",
       [](Recording& run) { column_named(run, "rate").units = "rad/s"; }},
      {"temperature: unit 'K'",
       [](Recording& run) { column_named(run, "temperature").units = "K"; }},
      {"time", [](Recording& run) { std::ranges::reverse(run.time); }},
      {"time", [](Recording& run) { run.time[7] = std::nan(""); }},
      {"time", [](Recording& run) { run = {}; }}};
  for (const auto& [words, make] : defects) {
    Recording run = run_;
    make(run);
    expect_refused(words, [&] { train(model_, {{"run", run}}); });
    expect_refused(words, [&] { train(model_, {{"a", run_}}, {{"b", run}}); });
    expect_refused(words, [&] { compensate(trained, run); });
    expect_refused(words, [&] { compensate(*user, run); });
    expect_refused(words, [&] { trained.answer(run); });
    EXPECT_THROW(write_recording(run, "untrusted_recording_test.h5"),
                 std::runtime_error)
        << words;
  }
}

TEST_F(UntrustedRecording, AllanReadsNothingBesideTheSamples) {
  Recording run = run_;
  run.status.clear();
  expect_refused("status", [&] { allan(run); });
  run = run_;
  column_named(run, "rate").values.resize(100);
  expect_refused("of rate", [&] { allan(run); });
  run = run_;
  column_named(run, "rate").values[5] = 1e13;
  expect_refused("sample 5 is 1e+13", [&] { allan(run); });
}

TEST_F(UntrustedRecording, AllanHasNoCoefficientsOfWhatIsBeyondNumbers) {
  std::vector<double> values = column_values(run_, "rate");
  for (double& value : values)
    value = std::isfinite(value) ? value * 1e-100 : 0.0;
  const AllanResult tiny = allan(values, 5.0);
  EXPECT_FALSE(tiny.curves.empty());
  EXPECT_TRUE(tiny.coefficients.empty());
  for (const double wrong : {1e-300, 1e300, 0.0, -1.0, std::nan("")})
    expect_refused("samples a second", [&] { allan(values, wrong); });
}

/// A class of a user's that may report a fault of its own.
class OfAUser final : public RateCompensator {
 public:
  std::string name() const override { return "mine"; }
  std::vector<std::string> inputs() const override { return {"rate"}; }
  CompensatedRate answer(const Recording& seen) const override {
    CompensatedRate answer{column_values(seen, "rate")};
    answer.clamped = 3;
    if (is_broken) answer.faults = {"the table is empty"};
    return answer;
  }

  bool is_broken = false;
};

TEST_F(UntrustedRecording, FaultsThatAClassReportsEndTheCompensation) {
  OfAUser mine;
  const CompensatedRun answered = compensate(mine, run_);
  ASSERT_EQ(answered.warnings.size(), 1U);
  EXPECT_TRUE(holds(answered.warnings[0], "3 of 3000 samples were clamped"));
  mine.is_broken = true;
  EXPECT_EQ(rejection<std::runtime_error>([&] { compensate(mine, run_); }),
            "mine: the table is empty");
}

TEST_F(UntrustedRecording, FaultsThatAClassReportsFailTheValidation) {
  OfAUser mine;
  const std::string path = testing::TempDir() + "fault_of_a_class.h5";
  write_recording(run_, path);
  const auto json = [&] {
    ValidationOptions options;
    options.recordings = {path};
    return validate(mine, options).json;
  };
  EXPECT_FALSE(holds(json(), "the table is empty"));
  mine.is_broken = true;
  const std::string found = json();
  const std::size_t check = found.find("\"name\": \"answers\"");
  ASSERT_NE(check, std::string::npos) << found;
  const std::string answers =
      found.substr(check, found.find('}', check) - check);
  EXPECT_TRUE(holds(answers, "\"passed\": false"));
  EXPECT_TRUE(holds(answers, "the table is empty"));
}

TEST_F(UntrustedRecording, ATruthThatCallsItselfMeasuredIsRefused) {
  Recording cheating = run_;
  column_named(cheating, "true_rate").role = Role::kMeasured;
  expect_refused("true_rate: role 'measured'; expected 'truth'",
                 [&] { compensate(OfAUser(), cheating); });
  EXPECT_THROW(write_recording(cheating, testing::TempDir() + "cheating.h5"),
               std::runtime_error);
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(WriteExported, KeepsWhatIsThereUntilAllFilesAreComplete) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "write_exported";
  std::filesystem::remove_all(folder);
  write_exported(folder, {{"a.c", "old"}});
  std::filesystem::create_directory(folder / "b.c");  // nothing can replace it
  expect_refused("b.c", [&] {
    write_exported(folder, {{"a.c", "new"}, {"b.c", "new"}});
  });
  EXPECT_EQ(contents(folder / "a.c"), "old");
  std::filesystem::remove(folder / "b.c");
  write_exported(folder, {{"a.c", "new"}, {"b.c", "new"}});
  EXPECT_EQ(contents(folder / "a.c") + contents(folder / "b.c"), "newnew");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file :
       std::filesystem::directory_iterator(folder))
    ++files;
  EXPECT_EQ(files, 2U);  // no partial ones
}

TEST(WriteExported, WritesNowhereButIntoItsDirectory) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "write_nowhere";
  expect_refused("a.c: the name of two files", [&] {
    write_exported(folder, {{"a.c", "one"}, {"a.c", "other"}});
  });
  expect_refused("17 files; expected at most 16", [&] {
    write_exported(folder, std::vector<ExportedFile>(17, {"a.c", ""}));
  });
  expect_refused("NUL", [&] {
    write_exported(folder, {{std::string("a.c\0.h", 6), "text"}});
  });
  for (const char* name : {"../escaped.txt", "/tmp/absolute.txt", "", ".."})
    expect_refused("expected the name of a file", [&] {
      write_exported(folder, {{name, "text"}});
    });
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST_F(UntrustedRecording, OptionsThatDoNotApplyAreRefused) {
  const OfAUser mine;
  const auto device =
      beamgyro::Device::read(kScenarios / "devices/nominal.toml");
  expect_refused("runs is for a set", [&] {
    validate(mine, {.recordings = {"absent.h5"}, .runs = {"ramp"}});
  });
  expect_refused("devices is for a set", [&] {
    validate(mine, {.recordings = {"absent.h5"}, .devices = {1}});
  });
  expect_refused("full_scale is for recordings", [&] {
    validate(mine, {.device = device,
                    .qualification = kScenarios / "qualification.toml",
                    .full_scale = 100.0});
  });
}

TEST_F(UntrustedRecording, MissingFunctionsAndProgramsAreNamed) {
  expect_refused("no function", [] { compensator_of("mine", {}, nullptr); });
  expect_refused("no function", [] {
    simulate_blocks(beamgyro::Scenario::read(kScenarios / "ten_minutes.toml"),
                    nullptr);
  });
  expect_refused("absent.so: No such file",
                 [] { open_compensator("absent.so"); });
  expect_refused("stall_s", [] {
    open_compensator("cmd:cat", {.stall_s = std::nan("")});
  });
  expect_refused("stall_s",
                 [] { open_compensator("cmd:cat", {.stall_s = 0.0}); });
}

TEST_F(UntrustedRecording, IdentifiersOfAutopilotsAreTheirs) {
  const Compensator cubic = train(model_, {{"run", run_}}).compensator;
  for (const std::int64_t wrong : {std::int64_t{-1}, std::int64_t{1} << 40})
    expect_refused("device id",
                   [&] { export_files({cubic}, "px4", {.device_id = wrong}); });
}

}  // namespace
}  // namespace beamgyro::internal::untrusted_recording_test
