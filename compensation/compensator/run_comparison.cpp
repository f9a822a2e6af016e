// SPDX-License-Identifier: MIT
#include "compensation/compensator/run_comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "dataset/files/sha256.h"
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

void add_text(const std::string& text, Sha256& hash) {
  hash.add(std::as_bytes(std::span(text)));
  hash.add(std::as_bytes(std::span("", 1)));  // NUL, which no name holds
}

void add_numbers(std::vector<double> numbers, Sha256& hash) {
  for (double& number : numbers)
    number = std::isnan(number) ? std::numeric_limits<double>::quiet_NaN()
                                : number + 0.0;  // one zero
  hash.add(std::as_bytes(std::span(numbers)));
}

template <class Is>
bool any_file(const Provenance& provenance, const Is& is) {
  return std::ranges::any_of(provenance.training, is) ||
         std::ranges::any_of(provenance.held_out, is);
}

bool is_same_set(const TrainingSet& a, const TrainingSet& b) {
  return a.manifest_sha256 == b.manifest_sha256 ||
         (!a.campaign_sha256.empty() &&
          a.campaign_sha256 == b.campaign_sha256 && a.seed == b.seed);
}

bool used(const TrainingSet& part, const TrainingRun& run) {
  const auto is_device = [&run](std::uint32_t number) {
    return std::to_string(number) == run.device;
  };
  return std::ranges::any_of(part.device_numbers, is_device) &&
         (part.devices > 1 ||
          std::ranges::find(part.runs, run.run) != part.runs.end());
}

bool shares_stretches_of_training(const Provenance& provenance,
                                  const Recording& recording) {
  std::uint64_t limit = 0;
  any_file(provenance, [&limit](const SourceFile& file) {
    if (!file.sketch.empty()) limit = std::max(limit, file.sketch.back());
    return false;
  });
  if (limit == 0) return false;
  const auto stretches = stretches_up_to(limit, recording);
  return any_file(provenance, [&stretches](const SourceFile& file) {
    return shares_stretches(file.sketch, stretches);
  });
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

std::string measured_sha256(const Recording& recording) {
  std::vector<const Column*> measured;
  for (const Column& column : recording.columns)
    if (column.role == Role::kMeasured) measured.push_back(&column);
  std::ranges::sort(measured, {}, &Column::name);
  Sha256 hash;
  add_numbers(recording.time, hash);
  hash.add(std::as_bytes(std::span(recording.status)));
  for (const Column* column : measured) {
    add_text(column->name, hash);
    add_numbers(column->values, hash);
  }
  return hash.digits();
}

bool was_used_in_training(const Provenance& provenance,
                          const std::string& file_sha256,
                          const Recording& recording) {
  if (any_file(provenance, [&](const SourceFile& file) {
        return !file_sha256.empty() && file.sha256 == file_sha256;
      }))
    return true;
  const auto states_measured = [](const SourceFile& file) {
    return !file.measured_sha256.empty();
  };
  if (!any_file(provenance, states_measured)) return false;
  const std::string measured = measured_sha256(recording);
  return any_file(provenance,
                  [&](const SourceFile& file) {
                    return file.measured_sha256 == measured;
                  }) ||
         shares_stretches_of_training(provenance, recording);
}

bool was_used_in_training(const Provenance& provenance, const TrainingSet& set,
                          const TrainingRun& run) {
  return std::ranges::any_of(
      std::array{&provenance.training_set, &provenance.held_out_set},
      [&](const std::optional<TrainingSet>* part) {
        return *part && is_same_set(**part, set) && used(**part, run);
      });
}

bool is_of_another_device(const Provenance& provenance,
                          const Recording& recording) {
  if (provenance.device_sha256.empty()) return false;
  const std::string device = stated_device(recording);
  return !device.empty() && sha256(device) != provenance.device_sha256;
}

bool is_of_other_devices(const Provenance& provenance, const TrainingSet& set) {
  const std::optional<TrainingSet>& trained = provenance.training_set;
  return trained && trained->device_numbers.size() == 1 &&
         is_same_set(*trained, set) &&
         std::ranges::count(set.device_numbers,
                            trained->device_numbers.front()) == 0;
}

bool may_have_used(const Provenance& provenance, const TrainingSet& set) {
  const std::optional<TrainingSet>& part = provenance.training_set;
  return part && part->device_numbers.empty() && is_same_set(*part, set);
}

std::string warning_of_no_training(const Provenance& provenance) {
  if (!provenance.training.empty() || provenance.training_set) return "";
  return "the compensator names no recording that it was trained on: these "
         "scores may be in-sample";
}

}  // namespace beamgyro::internal
