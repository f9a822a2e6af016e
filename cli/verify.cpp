// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iterator>
#include <stdexcept>

#include "api/generation.h"
#include "api/program_version.h"
#include "api/set_defects.h"
#include "cli/commands.h"
#include "cli/generate.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "sim/campaign/set_repair.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kDamaged = 1;
const ProgramRevision kProgram{kProgramVersion, kGitRevision};

struct VerifyArguments {
  std::string directory;
  unsigned jobs = 0;
  bool repair = false;
};

std::vector<FileDefect> checked(const fs::path& directory,
                                const Manifest& manifest) {
  Progress progress("verifying " + directory.string());
  return set_defects(directory, manifest,
                     [&](std::uint64_t done, std::uint64_t total) {
                       progress.set_share(static_cast<double>(done) /
                                          static_cast<double>(total));
                     });
}

std::string listed(const std::vector<FileDefect>& defects) {
  std::string text;
  for (const FileDefect& defect : defects)
    fmt::format_to(std::back_inserter(text), "{}: {}\n", defect.file,
                   defect.what);
  return text;
}

void repair(const fs::path& directory, const Manifest& manifest,
            const std::vector<FileDefect>& defects, unsigned jobs) {
  SetRepair repair(directory, manifest, defects, kProgram);
  require_moderate_files(directory.string(), repair.plan());
  repair.begin();
  for (const std::string& warning : lock_warnings(repair.set(), directory))
    print_warning(warning);
  set_interrupt_note(fmt::format(
      "{} keeps its whole files; the same command goes on with the others",
      directory.string()));
  generate_with_progress("repairing " + directory.string(), repair.plan(),
                         repair.files(), jobs,
                         [&](std::uint32_t file, const MadeShard& shard) {
                           repair.add(file, shard);
                         });
  repair.finish();
}

int verify(const VerifyArguments& arguments) {
  const fs::path directory = arguments.directory;
  Manifest manifest = manifest_of_set(directory);
  std::vector<FileDefect> defects = checked(directory, manifest);
  print_result(listed(defects));
  if (!defects.empty() && arguments.repair) {
    try {
      repair(directory, manifest, defects, arguments.jobs);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(error.what());  // of the set, not of the caller
    }
    manifest = manifest_of_set(directory);
    defects = checked(directory, manifest);
    print_result(defects.empty()
                     ? "repaired\n"
                     : "left after the repair:\n" + listed(defects));
  }
  if (!defects.empty()) {
    print_error(
        fmt::format("{}: {} defects", arguments.directory, defects.size()));
    return kDamaged;
  }
  const SetState state = set_contents(directory).state;
  if (every_device_failed(state)) {
    print_error(fmt::format("{}: {} files as the manifest says, but {}",
                            arguments.directory, manifest.entries.size(),
                            every_device_failed_text(state)));
    return kDamaged;
  }
  print_result(fmt::format("{}: whole, {} files, {} devices\n",
                           arguments.directory, manifest.entries.size(),
                           manifest.head->devices));
  return 0;
}

}  // namespace

void add_verify(CommandLine& program) {
  const auto [command, arguments] = program.add<VerifyArguments>(
      "verify", kFiles, "Compares every byte of a set with its manifest",
      verify);
  command.text({"DIR", "", "Directory of a set"}, arguments.directory);
  command.reads({{FileKind::kSet}});
  command.flag({"--repair", "",
                "Makes damaged and missing files again, with the same bytes"},
               arguments.repair);
  command.integer(
      {"--jobs", "N", "Number of threads of the repair", "one per core"},
      arguments.jobs, {1, 4096});
  command.example("beamgyro verify set --repair",
                  "Names damaged files and makes them again");
}

}  // namespace beamgyro::internal
