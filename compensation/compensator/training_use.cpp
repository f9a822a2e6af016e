// SPDX-License-Identifier: MIT
#include "compensation/compensator/training_use.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

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

}  // namespace

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

namespace {

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
