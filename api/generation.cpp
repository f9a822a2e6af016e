// SPDX-License-Identifier: MIT
#include "api/generation.h"

#include <fmt/format.h>

#include <mutex>
#include <stdexcept>

#include "api/program_version.h"
#include "api/reported_progress.h"
#include "include/beamgyro/option_error.h"
#include "sim/campaign/shard_making.h"

namespace beamgyro {
namespace internal {

void require_moderate_files(const std::string& campaign,
                            const ShardPlan& plan) {
  constexpr double kLargest = 1e9;  // [byte]
  const double size = plan.largest_file();
  if (size <= kLargest) return;
  throw std::invalid_argument(fmt::format(
      "{}: devices_per_file: {} devices make files of {:.1f} GB; expected at "
      "most {:g} GB, so fewer devices a file, fewer variables or lower rates",
      campaign, plan.campaign().devices_per_file, size / 1e9, kLargest / 1e9));
}

std::vector<std::string> lock_warnings(const SetWriter& set,
                                       const std::filesystem::path& directory) {
  if (set.is_locked()) return {};
  return {fmt::format(
      "{}: the file system has no locks (flock); start nothing else there "
      "that makes the same files, on another host least of all",
      directory.string())};
}

void require_nothing_lost(const std::filesystem::path& directory,
                          const SetTask& task, const ManifestHead& head,
                          const SetState& state) {
  for (std::uint32_t index = 0; index < state.planned; ++index) {
    if (task.makes(index) && !state.entries.contains(index))
      throw std::runtime_error(fmt::format(
          "{}: {} has vanished or changed since it was made; resuming the "
          "generation makes it again",
          directory.string(), expected_entry(head, index).file));
  }
  if (state.is_merged && every_device_failed(state))
    throw std::runtime_error(fmt::format("{}: {}", directory.string(),
                                         every_device_failed_text(state)));
}

std::string outcome_text(const SetState& state, std::uint64_t made) {
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

}  // namespace internal

namespace {

void make_files(const internal::ShardPlan& plan,
                const std::vector<std::uint32_t>& files,
                const GenerationOptions& options, internal::SetWriter& set) {
  const auto total = static_cast<double>(plan.device_runs(files));
  internal::GenerationCounts counts;
  std::mutex one_at_a_time;
  if (options.progress)
    counts.on_device_run = [&] {
      const std::lock_guard lock(one_at_a_time);
      internal::report(options.progress,
                       static_cast<double>(counts.device_runs.load()) / total);
    };
  internal::generate_shards(
      plan, files, options.jobs, counts,
      [&](std::uint32_t file, const internal::MadeShard& shard) {
        set.add(file, shard.bytes, shard.failures, shard.cautions);
      });
}

internal::SetTask task_of(const GenerationOptions& options) {
  const std::uint32_t number = options.shard, of = options.shards;
  if (number == 0 && of == 0) return {};
  if (number == 0 || number > of)
    throw OptionError([=](const OptionSpelling& spelled) {
      return fmt::format("{}: expected a task from 1 to their number",
                         spelled("shard", fmt::format("({}, {})", number, of)));
    });
  return {number, of};
}

}  // namespace

GenerationOutcome generate(const Campaign& campaign,
                           const std::filesystem::path& directory,
                           const GenerationOptions& options) {
  const internal::CampaignPlan& own = campaign.content();
  const internal::ShardPlan plan(
      own, {internal::kProgramVersion, internal::kGitRevision});
  internal::require_moderate_files(campaign.name(), plan);
  const internal::SetTask task = task_of(options);
  internal::SetWriter set(directory, plan.manifest_head(), own.sources, task,
                          options.resume);
  std::vector<std::string> warnings = internal::lock_warnings(set, directory);
  const std::vector<std::uint32_t> files = set.lacking();
  make_files(plan, files, options, set);
  const internal::SetState state = set.finish();
  internal::require_nothing_lost(directory, task, plan.manifest_head(), state);
  for (const std::string& text : internal::caution_texts(state))
    warnings.push_back(fmt::format("{}: {}", directory.string(), text));
  return {.files = state.entries.size(),
          .planned_files = state.planned,
          .is_whole = state.is_merged,
          .files_made = files.size(),
          .device_runs = state.device_runs(),
          .failures = state.failures(),
          .warnings = std::move(warnings),
          .text = internal::outcome_text(state, files.size())};
}

}  // namespace beamgyro
