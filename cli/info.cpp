// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "config/file_error.h"
#include "report/recording_report.h"
#include "report/set_report.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct InfoArguments {
  std::string path;
  std::optional<std::uint32_t> device;
};

int info(const InfoArguments& arguments) {
  const auto& [path, device] = arguments;
  if (fs::is_directory(status_of(path))) {
    print_result(device ? info_on_device(path, *device) : info_on_set(path));
    return 0;
  }
  if (device)
    throw std::invalid_argument(
        fmt::format("--device {}: {} is no directory; expected that of a set",
                    *device, path));
  std::vector<std::string> warnings;
  if (const auto of_shard = info_on_shard(path, warnings)) {
    print_result(*of_shard);
    for (const std::string& warning : warnings) print_warning(warning);
    return 0;
  }
  const Recording recording = load_recording(path);
  print_result(recording_report(path, recording));
  return 0;
}

}  // namespace

void add_info(CommandLine& program) {
  const auto [command, arguments] = program.add<InfoArguments>(
      "info", kFiles, "Prints what a recording or a set holds", info);
  command.text({"FILE", "", "RUN.h5, a file of a set, or its directory"},
               arguments.path);
  command.reads({{FileKind::kRecording, FileKind::kSetFile, FileKind::kSet}});
  command.integer({"--device", "K",
                   "Prints the --set values that make this device of a set",
                   "prints what the set holds"},
                  arguments.device, {0, kLastDevice});
  command.example("beamgyro info warm_up.h5",
                  "Variables, units, scenario and device of a recording");
  command.example("beamgyro info set --device 3",
                  "How to simulate device 3 alone");
}

}  // namespace beamgyro::internal
