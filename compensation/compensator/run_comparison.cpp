// SPDX-License-Identifier: MIT
#include "compensation/compensator/run_comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "compensation/compensator/training_use.h"
#include "dataset/recording/stated_values.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kLongSketch = 256;  // hashes

bool is_without_noise(const Recording& recording) {
  return stated_scenario_flag(recording, "noise.enabled") == false;
}

/// Says what two runs have in common, or nothing.
std::string repetition(const RunMark& a, const RunMark& b) {
  if (is_same_recording(a.file, b.file))
    return fmt::format("{}: is the same recording as {}", b.file.name,
                       a.file.name);
  if (!a.origin.empty() && !b.origin.empty() && a.origin != b.origin) return "";
  const bool is_part = is_part_of(b.file, a.file);
  if (!is_part && !is_part_of(a.file, b.file)) return "";
  const auto& [part, whole] = is_part ? std::pair(b, a) : std::pair(a, b);
  return fmt::format("{}: half or more of its samples are those of {}",
                     part.file.name, whole.file.name);
}

void require_different(const RunMark& a, const RunMark& b, const char* advice) {
  if (const std::string found = repetition(a, b); !found.empty())
    throw std::invalid_argument(fmt::format("{}; {}", found, advice));
}

void require_different_in(const std::vector<RunMark>& runs) {
  for (auto b = runs.begin(); b != runs.end(); ++b)
    for (auto a = runs.begin(); a != b; ++a)
      require_different(*a, *b, "expected each once: leave one of them out");
}

}  // namespace

RunMark mark_of(const TrainingRun& run) {
  const Recording& recording = run.recording;
  RunMark mark{{run.name, run.sha256, measured_sha256(recording),
                measured_sketch(recording, kLongSketch), noise_seed(recording)},
               {}};
  if (is_without_noise(recording))
    mark.origin = recording.scenario_text + '\0' + recording.device_text +
                  '\0' + recording.overrides_text;
  return mark;
}

std::optional<std::uint64_t> noise_seed(const Recording& recording) {
  const bool is_simulated =
      recording.fidelity != "imported" && recording.fidelity != "csv";
  const bool is_of_set = recording.title.empty();
  if (!is_simulated || is_of_set || is_without_noise(recording))
    return std::nullopt;
  return recording.seed;
}

bool is_same_recording(const SourceFile& a, const SourceFile& b) {
  return (!a.sha256.empty() && a.sha256 == b.sha256) ||
         (!a.measured_sha256.empty() && a.measured_sha256 == b.measured_sha256);
}

bool is_part_of(const SourceFile& part, const SourceFile& whole) {
  return shares_stretches(whole.sketch, part.sketch);
}

void require_different_runs(const std::vector<RunMark>& training,
                            const std::vector<RunMark>& held_out) {
  require_different_in(training);
  require_different_in(held_out);
  for (const RunMark& held : held_out)
    for (const RunMark& fitted : training)
      require_different(fitted, held,
                        "a held-out recording must be another run than those "
                        "that are trained on");
}

std::string warning_of_shared_seeds(const std::vector<SourceFile>& training,
                                    const std::vector<SourceFile>& held_out,
                                    bool cross_validated) {
  struct Names {
    std::vector<std::string> training, all;
  };
  std::map<std::uint64_t, Names> of_seed;
  for (const SourceFile& run : training)
    if (run.seed) of_seed[*run.seed].training.push_back(run.name);
  for (auto& [seed, names] : of_seed)
    if (cross_validated) names.all = names.training;
  for (const SourceFile& run : held_out) {
    const auto same = run.seed ? of_seed.find(*run.seed) : of_seed.end();
    if (same == of_seed.end()) continue;
    Names& names = same->second;
    if (names.all.empty()) names.all = names.training;
    names.all.push_back(run.name);
  }
  std::vector<std::string> found;
  for (const auto& [seed, names] : of_seed)
    if (names.all.size() > 1)
      found.push_back(fmt::format("{} share the seed of noise {}",
                                  fmt::join(names.all, ", "), seed));
  if (found.empty()) return "";
  return fmt::format(
      "{}: turn-on offset and noise are the same in them, so scores on unseen "
      "runs are too good; run all but one again with other seeds",
      fmt::join(found, "; "));
}

std::string shared_seed(const Provenance& provenance, const std::string& name,
                        const Recording& recording) {
  const auto seed = noise_seed(recording);
  if (!seed) return "";
  for (const auto& [kind, files] :
       {std::pair("training", &provenance.training),
        std::pair("held-out", &provenance.held_out)}) {
    const auto same = std::ranges::find(*files, seed, &SourceFile::seed);
    if (same != files->end())
      return fmt::format(
          "{} shares its seed of noise with the {} run {}: turn-on offset and "
          "noise are the same",
          name, kind, same->name);
  }
  return "";
}

}  // namespace beamgyro::internal
