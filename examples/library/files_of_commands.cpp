// SPDX-License-Identifier: MIT
// Makes the files that commands make, with the same bytes:
//
//   files_of_commands SCENARIOS SPECIFICATION
//
// The directory must hold ramp.h5, of `beamgyro run SCENARIOS/ramp.toml`.
#include <beamgyro/allan.h>
#include <beamgyro/campaign.h>
#include <beamgyro/compensator.h>
#include <beamgyro/device.h>
#include <beamgyro/export.h>
#include <beamgyro/scenario.h>
#include <beamgyro/sensitivity.h>
#include <beamgyro/set.h>
#include <beamgyro/simulate.h>
#include <beamgyro/train.h>
#include <beamgyro/validate.h>
#include <beamgyro/version.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

void make_files(const fs::path& scenarios, const fs::path& spec) {
  const std::vector<std::string> overrides = {"seed=5"};
  const auto scenario =
      beamgyro::Scenario::read(scenarios / "ten_minutes.toml", overrides);
  beamgyro::write_recording(beamgyro::simulate(scenario).recording, "run.h5");
  beamgyro::simulate_to_file(scenario, "run.csv");
  const auto device =
      beamgyro::Device::read(scenarios / "devices/nominal.toml");
  const std::vector<double> temperatures = {-20, -10, 0, 10, 20};
  write("device.csv", beamgyro::characterise(device, temperatures).csv);

  const auto model = beamgyro::Model::read(scenarios / "models/cubic.toml");
  const auto trained = beamgyro::train(model, std::vector<fs::path>{"ramp.h5"});
  trained.compensator.write("cubic.json");
  write("train.txt", trained.text);
  const auto cubic = beamgyro::Compensator::read("cubic.json");
  beamgyro::write_recording(
      beamgyro::compensate(cubic, beamgyro::read_recording("run.h5")).recording,
      "compensated.h5");
  const auto judged = beamgyro::validate(
      cubic, {.recordings = {"ramp.h5"}, .specification = spec});
  write("result.json", judged.json);
  write("result.txt", judged.text);
  const auto deviations = beamgyro::allan_of_file("run.h5");
  write("allan.json", deviations.json);
  write("allan.txt", deviations.text);
  fs::create_directory("firmware");
  for (const auto& file : beamgyro::export_files({cubic}, "c").files)
    write(fs::path("firmware") / file.name, file.text);

  const auto campaign =
      beamgyro::Campaign::read(scenarios / "campaigns/small.toml", 6);
  write("generate.txt", beamgyro::generate(campaign, "set").text);
  const auto on_set = beamgyro::train(model, beamgyro::Set::open("set"));
  on_set.compensator.write("of_set.json");
  const auto causes = beamgyro::sensitivity(campaign, {.samples = 32});
  write("sensitivity.txt", causes.text);
  write("sensitivity.json", causes.json);
  write("version", beamgyro::version());
}

}  // namespace

int main(int, char** argv) {
  make_files(argv[1], argv[2]);
  return 0;
}
