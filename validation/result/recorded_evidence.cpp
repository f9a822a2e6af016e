// SPDX-License-Identifier: MIT
#include "validation/result/recorded_evidence.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/run_comparison.h"
#include "compensation/scoring/rate_injection.h"
#include "parallel/work_queue.h"
#include "validation/evidence/recorded_purpose.h"

namespace beamgyro::internal {
namespace {

// Returns what a recording shows, under a name.
ReadRun named_run(const std::string& name, const Recording& recording) try {
  const RunPurpose purpose = recorded_purpose(recording);
  return {name, purpose, purpose == RunPurpose::kRest ? kRestBegins : 0.0};
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("{}: {}", name, error.what()));
}

// The constant trained on the same data; of a file that does not state it the
// mean of its cubic over the temperatures that training saw.
double constant_of(const FittedCompensator& compensator) {
  if (compensator.provenance.constant_bias)
    return *compensator.provenance.constant_bias;
  constexpr Eigen::Index kPlaces = 201;
  const TemperatureRange& range = compensator.temperature_range;
  const Eigen::ArrayXXd temperatures =
      Eigen::ArrayXd::LinSpaced(kPlaces, range.lowest, range.highest);
  return compensator.baseline.predict(temperatures).mean();
}

DeviceEvidence evidence_of(std::vector<ReadRun> read,
                           std::vector<Recording> recordings,
                           const RecordedAnswering& by, std::size_t threads) {
  std::optional<double> full_scale = by.full_scale;
  for (const Recording& recording : recordings)
    if (!full_scale) full_scale = stated_full_scale(recording);
  Answering answering{.compensator = by.compensator,
                      .baselines = {},
                      .full_scale = full_scale.value_or(kFullScale),
                      .reports_clamped = by.known != nullptr};
  if (by.known != nullptr) {
    answering.baselines.push_back(
        {"constant", [mean = constant_of(*by.known)](const Recording& run) {
           std::vector<double> rate = column_values(run, "rate");
           for (double& value : rate) value -= mean;
           return rate;
         }});
    answering.baselines.push_back(
        {"cubic", [known = by.known](const Recording& run) {
           return baseline_rate(*known, run);
         }});
    if (by.known->straight_lines)
      answering.baselines.push_back(
          {"straight_lines", [known = by.known](const Recording& run) {
             return straight_lines_rate(*known, run);
           }});
  }
  return answered_evidence(std::move(read), std::move(recordings), answering,
                           threads);
}

}  // namespace

DeviceEvidence recorded_evidence(std::size_t count,
                                 const RecordedAnswering& answering,
                                 std::size_t threads,
                                 const RecordingReader& reader,
                                 std::vector<std::string>& warnings) {
  std::vector<ReadRun> read(count);
  std::vector<std::vector<std::string>> warned(count);
  std::vector<Recording> recordings(count);
  std::vector<RunMark> marks(count);
  for_each_task(count, threads, [&](std::size_t k, std::size_t) {
    TrainingRun run = reader(k, &warned[k]);
    marks[k].file = {.name = run.name, .sha256 = run.sha256};
    // One without a temperature is refused by what reads it.
    if (find_column(run.recording, "temperature") != nullptr)
      marks[k] = mark_of(run);
    recordings[k] = std::move(run.recording);
    read[k] = named_run(run.name, recordings[k]);
    read[k].name = std::filesystem::path(run.name).filename().string();
    read[k].sha256 = run.sha256;
  });
  require_different_runs(marks);
  for (std::vector<std::string>& texts : warned)
    warnings.insert(warnings.end(), texts.begin(), texts.end());
  return evidence_of(std::move(read), std::move(recordings), answering,
                     threads);
}

DeviceEvidence recorded_evidence(std::vector<TrainingRun> runs,
                                 const RecordedAnswering& answering,
                                 std::size_t threads) {
  std::vector<ReadRun> read;
  std::vector<Recording> recordings;
  for (TrainingRun& run : runs) {
    read.push_back(named_run(run.name, run.recording));
    read.back().name = run.run;
    read.back().device = run.device;
    read.back().set_run = run.run;
    recordings.push_back(std::move(run.recording));
  }
  return evidence_of(std::move(read), std::move(recordings), answering,
                     threads);
}

}  // namespace beamgyro::internal
