// SPDX-License-Identifier: MIT
#include "include/beamgyro/allan.h"

#include <fmt/format.h>

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
  AllanFileOptions about;
  AllanOptions options;
};

int allan(AllanArguments& arguments) {
  require_json_output(arguments.json, {arguments.file});
  std::optional<Progress> progress("Allan deviation of " + arguments.file);
  arguments.options.progress = progress->shown_share();
  const AllanResult result =
      allan_of_file(arguments.file, arguments.about, arguments.options);
  progress.reset();
  for (const std::string& warning : result.warnings) print_warning(warning);
  if (!arguments.json.empty()) write_text_file(arguments.json, result.json);
  print_result(result.text);
  return 0;
}

}  // namespace

void add_allan(CommandLine& program) {
  const auto [command, arguments] = program.add<AllanArguments>(
      "allan", kFiles,
      "Computes Allan deviations and noise coefficients of a rate", allan);
  command.text({"FILE", "", "RUN.h5 or SERIES.csv"}, arguments.file);
  command.reads({{FileKind::kRecording},
                 {FileKind::kRecordingTable, FileKind::kCharacteristic,
                  FileKind::kProfile}});
  command.text({"--dataset", "NAME", "Variable or column", "rate"},
               arguments.about.column);
  command.number(
      {"--from", "S", "First time to use, in seconds", "the first sample"},
      arguments.options.from_s);
  command.number(
      {"--to", "S", "Last time to use, in seconds", "the last sample"},
      arguments.options.to_s);
  command.choices(
      {"--kind", "adev|oadev|mdev|hdev|ohdev|totdev",
       "Deviations to compute, between commas or repeated", "adev,oadev"},
      arguments.options.kinds,
      {"adev", "oadev", "mdev", "hdev", "ohdev", "totdev"});
  command.choice({"--taus", "octave|decade|all",
                  "Averaging times: 1, 2, 4, 8 samples and so on; 1, 2, 4, 10, "
                  "20, 40; or 1, 2, 3",
                  "octave"},
                 arguments.options.taus, {"octave", "decade", "all"});
  command.text({"--json", "FILE",
                "Writes the curve, the coefficients and the samples used to "
                "FILE",
                "no file"},
               arguments.json);
  command.group("What a CSV does not state");
  command.number(
      {"--rate-Hz", "F", "Sample rate of a CSV that has no column of times",
       "that of the times"},
      arguments.about.rate_Hz, {1e-9, 1e9});
  command.text({"--unit", "U",
                "Unit of a CSV: deg/s, deg/h, rad/s, or any other text, which "
                "is printed as it is",
                "deg/s"},
               arguments.about.unit);
  command.example("beamgyro allan rest.h5", "The rate of a recording");
  command.example("beamgyro allan rest.h5 --kind oadev,mdev --taus decade",
                  "Other deviations");
  command.example("beamgyro allan series.csv --rate-Hz 100 --unit deg/h",
                  "A column of rates without times");
}

}  // namespace beamgyro::internal
