// SPDX-License-Identifier: MIT
#include "cli/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "api/generation.h"
#include "api/program_version.h"
#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "dataset/set/set_writer.h"

namespace beamgyro::internal {
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

// Returns a word as a shell takes it.
std::string quoted(const std::string& word) {
  const bool is_plain = std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 ||
           std::string_view("/._-+:,=@%").find(static_cast<char>(c)) !=
               std::string_view::npos;
  });
  if (is_plain && !word.empty()) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string note_for_interruption(const GenerateArguments& arguments) {
  const std::string kept =
      fmt::format("{} keeps its finished files; ", arguments.output);
  if (!arguments.shard.empty())
    return kept + "the same command goes on with the others";
  std::string again =
      fmt::format("go on with: beamgyro generate {} -o {}",
                  quoted(arguments.campaign), quoted(arguments.output));
  if (arguments.devices)
    again += fmt::format(" --devices {}", *arguments.devices);
  if (arguments.jobs > 0) again += fmt::format(" --jobs {}", arguments.jobs);
  if (arguments.strict) again += " --strict";
  return kept + again + " --resume";
}

int generate(const GenerateArguments& arguments) {
  const SetTask task = task_of(arguments.shard);
  require_directory_name(arguments.output);
  const CampaignPlan campaign =
      CampaignPlan::read(arguments.campaign, arguments.devices);
  const ShardPlan plan(campaign, {kProgramVersion, kGitRevision});
  require_moderate_files(arguments.campaign, plan);
  if (arguments.lacking) {
    print_result(lacking_tasks(arguments.output, plan.manifest_head(),
                               *arguments.lacking) +
                 "\n");
    return 0;
  }
  require_set_output(arguments.output, plan.manifest_head(), campaign.sources);
  SetWriter set(arguments.output, plan.manifest_head(), campaign.sources, task,
                arguments.resume);
  for (const std::string& warning : lock_warnings(set, arguments.output))
    print_warning(warning);
  if (!set.died_before().empty())
    print_note(fmt::format(
        "{}: continuing the work of {}, which ended without finishing",
        arguments.output, set.died_before()));
  const std::vector<std::uint32_t> files = set.lacking();
  set_interrupt_note(note_for_interruption(arguments));
  generate_with_progress(
      "generating " + arguments.output, plan, files, arguments.jobs,
      [&](std::uint32_t file, const MadeShard& shard) {
        set.add(file, shard.bytes, shard.failures, shard.cautions);
      });
  const SetState state = set.finish();
  print_result(outcome_text(state, files.size()));
  for (const std::string& text : caution_texts(state))
    print_warning(fmt::format("{}: {}", arguments.output, text));
  require_nothing_lost(arguments.output, task, plan.manifest_head(), state);
  return arguments.strict && state.failures() > 0 ? kSomeDevicesFailed : 0;
}

}  // namespace

void generate_with_progress(const std::string& activity, const ShardPlan& plan,
                            const std::vector<std::uint32_t>& files,
                            unsigned jobs, const ShardSink& publish) {
  using Clock = std::chrono::steady_clock;
  const auto total = static_cast<double>(plan.device_runs(files));
  const double hours = plan.run_duration() / 3600;
  const Clock::time_point start = Clock::now();
  GenerationCounts counts;
  const auto done = [&] {
    const auto runs = static_cast<double>(counts.device_runs.load());
    const double elapsed =
        std::chrono::duration<double>(Clock::now() - start).count();
    return Progress::Status{runs / total,
                            fmt::format("{} of {} runs, {} failed, {:.3g} "
                                        "device-h/s",
                                        runs, total, counts.failures.load(),
                                        runs * hours / elapsed)};
  };
  const Progress progress(activity, done);
  generate_shards(plan, files, jobs, counts, publish);
}

void add_generate(CommandLine& program) {
  const auto [command, arguments] = program.add<GenerateArguments>(
      "generate", kSimulation,
      "Simulates every device of a campaign and writes the set to a directory",
      generate);
  command.text({"CAMPAIGN.toml", "", "Campaign file"}, arguments.campaign);
  command.reads({{FileKind::kCampaign}});
  command.text({"-o,--output", "DIR", "Directory of the set"},
               arguments.output);
  command.integer(
      {"--devices", "N", "Number of devices", "that of the campaign"},
      arguments.devices, {1, 4000000000});
  command.integer({"--jobs", "N", "Number of threads", "one per core"},
                  arguments.jobs, {1, 4096});
  command.flag({"--resume", "", "Continues the set that is in the directory"},
               arguments.resume);
  command.flag({"--strict", "", "Ends with status 4 when devices failed"},
               arguments.strict);
  command.group("Several tasks that share the directory");
  command.text(
      {"--shard", "I/N", "Makes only the files of task I of N", "all files"},
      arguments.shard);
  command.integer(
      {"--lacking", "N",
       "Makes nothing; prints which of N tasks have work left", "not asked"},
      arguments.lacking, {1, 1000000});
  command.exclude("--lacking", {"--shard", "--resume", "--strict"});
  command.example("beamgyro generate scenarios/campaigns/small.toml -o small",
                  "A small set");
  command.example(
      "beamgyro generate scenarios/campaigns/small.toml -o small --resume",
      "Goes on after an interruption");
}

}  // namespace beamgyro::internal
