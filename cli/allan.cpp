// SPDX-License-Identifier: MIT
#include "include/beamgyro/allan.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"

namespace beamgyro::internal {
namespace {

struct AllanArguments {
  std::string file, json;
  std::optional<std::string> dataset, unit;
  std::optional<double> rate, from, to;
  std::vector<std::string> kinds;
  std::string taus = "octave";
};

AllanOptions allan_options(const AllanArguments& arguments) {
  AllanOptions options;
  if (!arguments.kinds.empty()) options.kinds = arguments.kinds;
  options.taus = arguments.taus;
  options.from_s = arguments.from.value_or(options.from_s);
  options.to_s = arguments.to.value_or(options.to_s);
  return options;
}

int allan(const AllanArguments& arguments) {
  AllanOptions options = allan_options(arguments);
  if (!arguments.json.empty()) {
    require_output(arguments.json, {arguments.file});
    require_json_name(arguments.json);
  }
  std::optional<Progress> progress("Allan deviation of " + arguments.file);
  options.progress = [&](double share) {
    progress->set_share(share);
    return true;
  };
  const AllanResult result = allan_of_file(
      arguments.file, {arguments.dataset, arguments.rate, arguments.unit},
      options);
  progress.reset();
  for (const std::string& warning : result.warnings) print_warning(warning);
  if (!arguments.json.empty()) write_text_file(arguments.json, result.json);
  print_result(result.text);
  return 0;
}

}  // namespace

void add_allan(CommandLine& program) {
  auto arguments = std::make_shared<AllanArguments>();
  Command& command =
      program.add("allan", kFiles,
                  "Computes Allan deviations and noise coefficients of a rate");
  command.argument({"FILE", "", "RUN.h5 or SERIES.csv"}, arguments->file);
  command.reads({{FileKind::kRecording},
                 {FileKind::kRecordingTable, FileKind::kCharacteristic,
                  FileKind::kProfile}});
  command.text({"--dataset", "NAME", "Variable or column", "rate"},
               arguments->dataset);
  command.number(
      {"--from", "S", "First time to use, in seconds", "the first sample"},
      arguments->from);
  command.number(
      {"--to", "S", "Last time to use, in seconds", "the last sample"},
      arguments->to);
  command.choices({"--kind", "KIND",
                   "Deviations to compute, between commas or repeated: adev, "
                   "oadev, mdev, hdev, ohdev, totdev",
                   "adev,oadev"},
                  arguments->kinds,
                  {"adev", "oadev", "mdev", "hdev", "ohdev", "totdev"});
  command.choice({"--taus", "octave|decade|all",
                  "Averaging times: 1, 2, 4, 8 samples and so on; 1, 2, 4, 10, "
                  "20, 40; or 1, 2, 3",
                  "octave"},
                 arguments->taus, {"octave", "decade", "all"});
  command.text({"--json", "FILE",
                "Writes the curve, the coefficients and the samples used to "
                "FILE",
                "no file"},
               arguments->json);
  command.group("What a CSV does not state");
  command.number(
      {"--rate-Hz", "F", "Sample rate of a CSV that has no column of times",
       "that of the times"},
      arguments->rate, {1e-9, 1e9});
  command.text({"--unit", "U",
                "Unit of a CSV: deg/s, deg/h, rad/s, or any other text, which "
                "is printed as it is",
                "deg/s"},
               arguments->unit);
  command.example("beamgyro allan rest.h5", "The rate of a recording");
  command.example("beamgyro allan rest.h5 --kind oadev,mdev --taus decade",
                  "Other deviations");
  command.example("beamgyro allan series.csv --rate-Hz 100 --unit deg/h",
                  "A column of rates without times");
  command.action([arguments] { return allan(*arguments); });
}

}  // namespace beamgyro::internal
