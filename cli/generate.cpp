// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "cli/commands.h"
#include "cli/generation_progress.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "dataset/set/set_writer.h"
#include "report/set_report.h"

namespace beamgyro {
namespace {

constexpr int kSomeDevicesFailed = 4;

struct GenerateArguments {
  std::string campaign, output, shard;
  std::optional<long> devices;
  std::optional<std::uint32_t> lacking;
  unsigned jobs = 0;
  bool resume = false, strict = false;
};

// Returns the whole number in `text`, at least 1, or nothing.
std::optional<std::uint32_t> number(std::string_view text) {
  std::uint32_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last || value == 0) return {};
  return value;
}

SetTask task_of(std::string_view shard) {
  if (shard.empty()) return {};
  const std::size_t slash = shard.find('/');
  if (slash != std::string_view::npos) {
    const auto task = number(shard.substr(0, slash));
    const auto of = number(shard.substr(slash + 1));
    if (task && of && *task <= *of) return {*task, *of};
  }
  throw std::invalid_argument(
      fmt::format("--shard {}: expected I/N with I = 1..N", shard));
}

// Throws when files of the task that were made have vanished.
void require_nothing_lost(const std::string& output, const SetTask& task,
                          const ManifestHead& head, const SetState& state) {
  for (std::uint32_t index = 0; index < state.planned; ++index) {
    if (task.makes(index) && !state.entries.contains(index))
      throw std::runtime_error(fmt::format(
          "{}: {} has vanished or changed since it was made; --resume makes it "
          "again",
          output, expected_entry(head, index).file));
  }
}

std::string outcome(const SetState& state, std::uint64_t made) {
  std::string text =
      fmt::format("{} of {} files, {} made now; {} device runs, {} failed\n",
                  state.entries.size(), state.planned, made,
                  state.device_runs(), state.failures());
  if (!state.is_merged)
    text += fmt::format("{} files are missing\n",
                        state.planned - state.entries.size());
  else if (!every_device_failed(state))
    text += "the set is whole\n";
  return text;
}

int generate(const GenerateArguments& arguments) {
  const SetTask task = task_of(arguments.shard);
  require_directory_name(arguments.output);
  const Campaign campaign =
      Campaign::read(arguments.campaign, arguments.devices);
  const ShardPlan plan(campaign, {kProgramVersion, kGitRevision});
  require_moderate_files(arguments.campaign, plan);
  if (arguments.lacking) {
    print_result(lacking_tasks(arguments.output, plan.manifest_head(),
                               *arguments.lacking) +
                 "\n");
    return 0;
  }
  require_set_output(arguments.output, plan.manifest_head(),
                     campaign.sources());
  SetWriter set(arguments.output, plan.manifest_head(), campaign.sources(),
                task, arguments.resume);
  warn_without_lock(set, arguments.output);
  if (!set.died_before().empty())
    print_note(fmt::format(
        "{}: continuing the work of {}, which ended without finishing",
        arguments.output, set.died_before()));
  const std::vector<std::uint32_t> files = set.lacking();
  generate_with_progress("generating " + arguments.output, plan, files,
                         arguments.jobs,
                         [&](std::uint32_t file, const MadeShard& shard) {
                           set.add(file, shard.bytes, shard.failures);
                         });
  const SetState state = set.finish();
  print_result(outcome(state, files.size()));
  require_nothing_lost(arguments.output, task, plan.manifest_head(), state);
  if (state.is_merged && every_device_failed(state))
    throw std::runtime_error(fmt::format("{}: {}", arguments.output,
                                         every_device_failed_text(state)));
  return arguments.strict && state.failures() > 0 ? kSomeDevicesFailed : 0;
}

}  // namespace

void add_generate(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* command = program.add_subcommand(
      "generate",
      "Simulate every device of a campaign and write the set to a directory");
  command->add_option("campaign", arguments->campaign, "CAMPAIGN.toml")
      ->required();
  command->add_option("-o,--output", arguments->output, "DIR")->required();
  command->add_option("--devices", arguments->devices,
                      "Replaces the number of devices of the campaign");
  command
      ->add_option("--jobs", arguments->jobs,
                   "Number of threads; the default is one per core")
      ->check(CLI::Range(1, 4096));
  CLI::Option* shard = command->add_option(
      "--shard", arguments->shard,
      "I/N makes only the files of task I of N tasks that share the directory");
  CLI::Option* resume =
      command->add_flag("--resume", arguments->resume,
                        "Continues the set that is in the directory");
  CLI::Option* strict = command->add_flag(
      "--strict", arguments->strict, "Ends with status 4 when devices failed");
  command
      ->add_option("--lacking", arguments->lacking,
                   "Makes nothing; prints which of N tasks have work left")
      ->check(CLI::Range(1, 1000000))
      ->excludes(shard, resume, strict);
  command->callback([arguments, &action] {
    action = [arguments] { return generate(*arguments); };
  });
}

}  // namespace beamgyro
