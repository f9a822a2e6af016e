// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/training/model_file.h"
#include "validation/evidence/evidence.h"
#include "validation/external/tested_compensator.h"
#include "validation/qualification/qualification.h"
#include "validation/qualification/qualified_runs.h"

namespace beamgyro::internal {

/// A method that a compensator is compared with, trained on the same runs.
struct Baseline {
  // "none", "constant", "cubic", "spline", "table", "straight_lines"
  std::string name;
  Evidence evidence;
  bool has_metrics = true;  // or only a place among the comparisons
};

/// A run as metrics read it.
struct ReadRun {
  std::string name;
  RunPurpose purpose = RunPurpose::kSoak;
  double from = 0.0;                      // [s]
  std::string sha256 = {};                // of its file, if it has one
  std::string device = {}, set_run = {};  // of a set: whose run, and which one
};

/// Everything that a qualification shows of one device: its runs, the recorded
/// rate, that of the compensator and those of the baselines.
struct DeviceEvidence {
  std::vector<ReadRun> read;        // names of the runs
  std::vector<Recording> runs;      // whole, in the order of the qualification
  std::vector<Recording> late;      // from ReadRun::from on, or empty
  std::vector<Answer> answers;      // to `runs`
  Evidence before, after;           // of `runs`, or of `late` where there is
  std::vector<Baseline> baselines;  // with "none", the recorded rate
};

/// Work that is done, for a line of progress. Called from any thread.
using ProgressOfWork = std::function<void(double share)>;

/// The runs of a device that are trained on.
struct TrainingData {
  std::vector<TrainingRun> training, held_out;
  std::vector<TrainingRun> turning;  // for models that correct scale factors
};

/// Simulates the training runs of a qualification; the held-out ones only if
/// `model` is a network, those for the scale factor only if it corrects that.
/// `model` is null for the baselines alone. A run is known by the
/// SHA-256 of its measured variables.
TrainingData training_data(const Qualification& qualification,
                           const QualifiedDevice& device,
                           const ModelSpec* model, std::size_t threads);

/// Trains a model on them with seed 0: on the turning runs if it corrects the
/// scale factor, with the held-out runs if it is a network. Throws as train().
FittedCompensator trained_on(const TrainingData& data, const ModelSpec& model);

/// A method whose answers stand beside those of a compensator.
struct BaselineMethod {
  std::string name;
  std::function<std::vector<double>(const Recording&)> rate;  // [deg/s]
  bool has_metrics = true;                                    // as Baseline
};

/// How runs are answered.
struct Answering {
  const TestedCompensator& compensator;
  std::vector<BaselineMethod> baselines = {};  // beside "none"
  double full_scale = 150.0;                   // [deg/s]
  // Whether the answers count the samples outside what training saw.
  bool reports_clamped = false;
};

/// Answers runs with the compensator and every baseline. `on_done`, if there is
/// one, is called after each run.
DeviceEvidence answered_evidence(std::vector<ReadRun> read,
                                 std::vector<Recording> runs,
                                 const Answering& answering,
                                 std::size_t threads,
                                 const std::function<void()>& on_done = {});

/// Replaces the answers, and `after`, by those of another compensator.
void answer_again(DeviceEvidence& found, const TestedCompensator& compensator,
                  bool reports_clamped, std::size_t threads);

/// Simulates the runs of a qualification and answers them. The baselines
/// "constant", "cubic", "spline", "table" and "straight_lines" are trained on
/// `data`; without training runs there are none of them, and without two soaks
/// among these no straight lines.
DeviceEvidence device_evidence(const Qualification& qualification,
                               const QualifiedDevice& device,
                               const TestedCompensator& compensator,
                               const TrainingData& data, bool reports_clamped,
                               std::size_t threads,
                               const ProgressOfWork& progress = {});

}  // namespace beamgyro::internal
