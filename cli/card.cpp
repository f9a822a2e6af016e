// SPDX-License-Identifier: MIT
#include "include/beamgyro/card.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

struct CardArguments {
  std::string directory;
  SetCardOptions options;
};

int run_card(const CardArguments& arguments) {
  const Set set = Set::open(arguments.directory);
  std::optional<Progress> progress("reading " + arguments.directory);
  SetCardOptions options = arguments.options;
  options.progress = progress->shown_share();
  const std::vector<std::string> warnings = write_card(set, options);
  progress.reset();
  for (const std::string& warning : warnings)
    print_warning(fmt::format("{}: {}", arguments.directory, warning));
  print_result(fmt::format("{}: croissant.json and README.md written\n",
                           arguments.directory));
  return 0;
}

}  // namespace

void add_card(CommandLine& program) {
  const auto [command, arguments] = program.add<CardArguments>(
      "card", kFiles,
      "Writes a Croissant file and a data card beside the files of a set",
      run_card);
  command.text({"DIR", "", "Directory of a set"}, arguments.directory);
  command.reads({{FileKind::kSet}});
  SetCardOptions& options = arguments.options;
  command.text({"--license", "TEXT",
                "Licence of the set: an address, or a name of SPDX such as "
                "CC-BY-4.0",
                "none"},
               options.license);
  command.text({"--url", "URL", "Page of the set", "none"}, options.url);
  command.text({"--creator", "NAME", "Who made it", "none"}, options.creator);
  command.text({"--date", "DATE", "Date of publication, YYYY-MM-DD", "none"},
               options.date);
  command.text({"--set-version", "A.B.C", "Version of the set", "1.0.0"},
               options.version);
  command.example("beamgyro card set --license CC-BY-4.0",
                  "set/croissant.json and set/README.md");
}

}  // namespace beamgyro::internal
