// SPDX-License-Identifier: MIT
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/file_kind.h"
#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "include/beamgyro/compensator.h"

namespace beamgyro::internal {
namespace {

struct PlotArguments {
  std::vector<std::string> files;
  std::optional<std::string> output;
  bool compare = false;
};

// Returns a line for each file: the curve of a compensator, else "null".
// Damage and values that no command would take are refused as elsewhere.
std::string curves_of(const std::vector<std::string>& files) {
  std::string curves;
  for (const std::string& file : files) {
    if (is_of_kind(file, FileKind::kRecording)) load_recording(file);
    curves += is_of_kind(file, FileKind::kCompensator)
                  ? beamgyro::Compensator::read(file).curve()
                  : "null";
    curves += '\n';
  }
  return curves;
}

int plot(const PlotArguments& arguments) {
  if (arguments.output) {
    require_picture_name("-o", *arguments.output);
    require_output(*arguments.output,
                   {arguments.files.begin(), arguments.files.end()});
  }
  const std::string curves = curves_of(arguments.files);
  if (!arguments.output) {
    show_files(arguments.files, curves, arguments.compare);
    return 0;
  }
  const Progress progress("drawing " + arguments.files.front());
  draw_files(arguments.files, curves, arguments.compare, *arguments.output);
  return 0;
}

}  // namespace

void add_plot(CommandLine& program) {
  const auto [command, arguments] = program.add<PlotArguments>(
      "plot", kFiles,
      "Draws a file that this program wrote; needs Python with matplotlib",
      plot);
  command.list(
      {"FILE", "",
       "Recording, table or curves of `characterise`, compensator, set, "
       "or what --json of allan, validate, plan or sensitivity "
       "wrote"},
      arguments.files);
  command.reads(
      {{FileKind::kRecording, FileKind::kCharacteristic, FileKind::kCurves,
        FileKind::kCompensator, FileKind::kSet, FileKind::kResult},
       {FileKind::kSetFile}});
  command.text({"-o,--output", "PICTURE.png|svg", "Picture to write",
                "a window for each file"},
               arguments.output);
  command.flag({"--compare", "",
                "Draws files of one kind over each other: recordings, tables, "
                "Allan deviations or compensators"},
               arguments.compare);
  command.example("beamgyro plot warm_up.h5 -o warm_up.png",
                  "Rate, temperature and drive loop over time");
  command.example("beamgyro plot cubic.json bp.json --compare -o bias.svg",
                  "What two compensators take away over temperature");
}

}  // namespace beamgyro::internal
