// SPDX-License-Identifier: MIT
#include "validation/result/recorded_evidence.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "compensation/scoring/rate_injection.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "dataset/log/recording_csv.h"
#include "dataset/netcdf/recording_reader.h"
#include "parallel/work_queue.h"
#include "validation/evidence/recorded_purpose.h"

namespace beamgyro {
namespace {

Recording read_any(const std::filesystem::path& path) {
  return path.extension() == ".csv"
             ? parse_recording_csv(read_text_file(path), path)
             : read_recording(path);
}

ReadRun named_run(const std::filesystem::path& path,
                  const Recording& recording) try {
  const RunPurpose purpose = recorded_purpose(recording);
  return {path.filename().string(), purpose,
          purpose == RunPurpose::kRest ? kRestBegins : 0.0,
          sha256_of_file(path)};
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(
      fmt::format("{}: {}", path.string(), error.what()));
}

}  // namespace

DeviceEvidence recorded_evidence(const std::vector<std::filesystem::path>& runs,
                                 const TestedCompensator& compensator,
                                 const Compensator* known,
                                 std::optional<double> full_scale,
                                 std::size_t threads) {
  std::vector<ReadRun> read(runs.size());
  std::vector<Recording> recordings(runs.size());
  for_each_task(runs.size(), threads, [&](std::size_t k, std::size_t) {
    recordings[k] = read_any(runs[k]);
    read[k] = named_run(runs[k], recordings[k]);
  });
  for (const Recording& recording : recordings)
    if (!full_scale) full_scale = stated_full_scale(recording);
  Answering answering{.compensator = compensator,
                      .baselines = {},
                      .full_scale = full_scale.value_or(kFullScale),
                      .tells_clamped = known != nullptr};
  if (known != nullptr)
    answering.baselines.push_back({"cubic", [known](const Recording& run) {
                                     return baseline_rate(*known, run);
                                   }});
  return answered_evidence(std::move(read), std::move(recordings), answering,
                           threads);
}

}  // namespace beamgyro
