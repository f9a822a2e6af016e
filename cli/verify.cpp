// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/generation_progress.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "config/file_error.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/set_check.h"
#include "dataset/set/set_writer.h"
#include "dataset/set/view_check.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

constexpr int kDamaged = 1;

struct VerifyArguments {
  std::string directory;
  unsigned jobs = 0;
  bool repair = false;
};

// Reads the manifest, or the parts of tasks that are not merged yet. If the
// manifests are lost, the copy of the first line still defines the set.
Manifest manifest_of(const fs::path& directory) {
  Manifest manifest;
  if (fs::is_directory(status_of(directory))) {
    if (find_in_set(directory, kManifestName))
      manifest = read_manifest(directory, kManifestName);
    if (manifest.is_finished) return manifest;
    if (!find_set(directory) && find_in_set(directory, kHeadCopyName)) {
      manifest.head = read_manifest(directory, kHeadCopyName).head;
      if (manifest.head) return manifest;
    }
  }
  const SetContents contents = set_contents(directory);
  manifest.head = contents.head;
  manifest.entries.clear();
  for (const auto& [index, entry] : contents.state.entries)
    manifest.entries.push_back(entry);
  return manifest;
}

std::vector<SetDefect> checked(const fs::path& directory,
                               const Manifest& manifest) {
  Progress progress("verifying " + directory.string());
  std::vector<SetDefect> defects = check_set(
      directory, manifest, [&](std::uint64_t done, std::uint64_t total) {
        progress.set_share(static_cast<double>(done) /
                           static_cast<double>(total));
      });
  // Another program may make views of other bytes.
  if (manifest.head && manifest.head->program_version == kProgramVersion &&
      manifest.head->git_revision == kGitRevision)
    std::ranges::copy(check_views(directory, manifest, defects),
                      std::back_inserter(defects));
  return defects;
}

std::string listed(const std::vector<SetDefect>& defects) {
  std::string text;
  for (const SetDefect& defect : defects)
    fmt::format_to(std::back_inserter(text), "{}: {}\n", defect.file,
                   defect.what);
  return text;
}

ManifestHead repairable_head(const fs::path& directory,
                             const Manifest& manifest) {
  if (!manifest.head || manifest.head->sources.empty())
    throw std::runtime_error(
        fmt::format("{}: the manifest has lost the line that names the "
                    "campaign; run generate "
                    "--resume with the campaign",
                    directory.string()));
  if (manifest.head->program_version != kProgramVersion ||
      manifest.head->git_revision != kGitRevision)
    throw std::runtime_error(fmt::format(
        "{}: was made by beamgyro {} ({}), and this is {} ({}), which may not "
        "make the same bytes; repair it with the same program",
        directory.string(), manifest.head->program_version,
        manifest.head->git_revision, kProgramVersion, kGitRevision));
  return *manifest.head;
}

Campaign campaign_of(const fs::path& directory, const Manifest& manifest) try {
  restore_copies(directory, manifest);
  return Campaign::of_copies(read_copies(directory, *manifest.head),
                             manifest.head->devices);
} catch (const FileError&) {
  throw;
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {
  // A file that cannot be read counts as damaged.
  throw std::runtime_error(
      fmt::format("{}; run generate --resume with the campaign that the set "
                  "was made of",
                  error.what()));
}

void repair(const fs::path& directory, const Manifest& manifest,
            const std::vector<SetDefect>& defects, unsigned jobs) {
  const ManifestHead head = repairable_head(directory, manifest);
  const Campaign campaign = campaign_of(directory, manifest);
  const ShardPlan plan(campaign, {kProgramVersion, kGitRevision});
  // The campaign alone decides what is written. A manifest that differs, such
  // as a forged one, is refused.
  if (plan.manifest_head() != head)
    throw std::runtime_error(
        fmt::format("{}: the manifest is not that of the campaign beside it; "
                    "run generate --resume with the campaign that the set was "
                    "made of",
                    directory.string()));
  require_moderate_files(directory.string(), plan);
  std::set<std::uint32_t> files;
  for (const SetDefect& defect : defects) {
    if (defect.index) files.insert(*defect.index);
  }
  std::map<std::uint32_t, std::string> hashes;
  for (const ManifestEntry& entry : manifest.entries)
    hashes.emplace(entry.index, entry.sha256);

  SetWriter set(directory, head, {}, {}, true);
  warn_without_lock(set, directory);
  generate_with_progress(
      "repairing " + directory.string(), plan, {files.begin(), files.end()},
      jobs, [&](std::uint32_t file, const MadeShard& shard) {
        const auto hash = hashes.find(file);
        if (hash != hashes.end() && hash->second != sha256(shard.bytes))
          throw std::runtime_error(fmt::format(
              "{}: this machine makes other bytes than the manifest has; "
              "repair the set on a machine of the kind that made it",
              expected_entry(head, file).file));
        set.add(file, shard.bytes, shard.failures);
      });
  set.finish(true);
}

int verify(const VerifyArguments& arguments) {
  const fs::path directory = arguments.directory;
  Manifest manifest = manifest_of(directory);
  std::vector<SetDefect> defects = checked(directory, manifest);
  print_result(listed(defects));
  if (!defects.empty() && arguments.repair) {
    try {
      repair(directory, manifest, defects, arguments.jobs);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(error.what());  // of the set, not of the caller
    }
    manifest = manifest_of(directory);
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
  print_result(fmt::format("{}: whole, {} files, {} devices\n",
                           arguments.directory, manifest.entries.size(),
                           manifest.head->devices));
  return 0;
}

}  // namespace

void add_verify(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = program.add_subcommand(
      "verify", "Compare every byte of a set with its manifest");
  command->add_option("directory", arguments->directory, "DIR")->required();
  command->add_flag(
      "--repair", arguments->repair,
      "Makes damaged and missing files again, with the same bytes");
  command
      ->add_option(
          "--jobs", arguments->jobs,
          "Number of threads of the repair; the default is one per core")
      ->check(CLI::Range(1, 4096));
  command->callback([arguments, &action] {
    action = [arguments] { return verify(*arguments); };
  });
}

}  // namespace beamgyro
