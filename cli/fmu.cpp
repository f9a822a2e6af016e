// SPDX-License-Identifier: MIT
#include "include/beamgyro/fmu.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "config/file_error.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct FmuArguments {
  fs::path device, output;
  std::string fmi = "2", fidelity = "quasistatic";
  std::vector<std::string> overrides;
};

// Beside the program in a folder of a build, in lib where it is installed.
fs::path fmu_binary() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* name :
       {"beamgyro_fmu.so", "../lib/beamgyro/beamgyro_fmu.so"})
    if (const fs::path file = (folder / name).lexically_normal();
        fs::exists(status_of(file)))
      return file;
  throw std::invalid_argument(
      "beamgyro_fmu.so is not beside this program; expected it in " +
      (folder / "../lib/beamgyro").lexically_normal().string());
}

int run_fmu(const FmuArguments& arguments) {
  require_ending(arguments.output, {".fmu"});
  require_output(arguments.output, {arguments.device});
  write_fmu(Device::read(arguments.device, arguments.overrides),
            arguments.output,
            {.fmi = arguments.fmi == "2" ? 2 : 3,
             .fidelity = arguments.fidelity,
             .binary = fmu_binary()});
  return 0;
}

}  // namespace

void add_fmu(CommandLine& program) {
  const auto [command, arguments] = program.add<FmuArguments>(
      "fmu", kSimulation,
      "Writes a gyro as a functional mock-up unit for co-simulation", run_fmu);
  command.text({"DEVICE.toml", "", "Device file"}, arguments.device);
  command.reads({{FileKind::kDevice}});
  command.text({"-o,--output", "GYRO.fmu", "File to write"}, arguments.output);
  command.choice({"--fmi", "2|3", "Version of the standard FMI", "2"},
                 arguments.fmi, {"2", "3"});
  command.choice({"--fidelity", "quasistatic|envelope",
                  "Envelope follows the loops, too", "quasistatic"},
                 arguments.fidelity, {"quasistatic", "envelope"});
  command.texts(
      {"--set", "KEY=VALUE", "Replaces a key of the device; may be repeated",
       "the file as it is"},
      arguments.overrides);
  command.example(
      "beamgyro fmu scenarios/devices/nominal.toml --fmi 3 -o gyro.fmu",
      "A gyro for a master of FMI 3.0");
}

}  // namespace beamgyro::internal
