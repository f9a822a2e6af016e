// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/set_runs.h"
#include "compensation/training/model_file.h"
#include "validation/external/tested_compensator.h"
#include "validation/result/device_evidence.h"
#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// A compensator in memory: one of the first three.
struct GivenCompensator {
  std::shared_ptr<const TestedCompensator> tested = {};
  std::optional<Compensator> trained = {};
  std::optional<ModelSpec> model = {};   // to be trained as one of a file
  std::string kind;                      // as JudgedCompensator
  std::optional<std::string> text = {};  // of its file
};

/// A device in memory.
struct GivenDevice {
  std::string text;  // of its file
  std::vector<std::string> overrides;
};

/// What `validate` is asked for. Files are named as the user does.
struct ValidationRequest {
  // FILE.json, FILE.so, "cmd:PROGRAM ARGS", or a model file (MODEL.toml) that
  // is trained on the training runs of the qualification.
  std::string compensator;
  // In place of that file; `compensator` is its name.
  std::optional<GivenCompensator> given = {};
  // A device and what it goes through, or else recordings.
  std::optional<std::filesystem::path> device = {};
  // In place of that file; `device` is its name.
  std::optional<GivenDevice> given_device = {};
  std::filesystem::path qualification = {};
  std::vector<std::filesystem::path> runs = {};
  // Or the directory of a set, and what is chosen from it.
  std::optional<std::filesystem::path> set = {};
  SetSelection selection = {};
  std::optional<double> full_scale = {};  // [deg/s], of recordings
  std::optional<std::filesystem::path> specification = {};
  // A compensator file that the answers are compared with.
  std::optional<std::filesystem::path> workbench = {};
  std::optional<std::filesystem::path> campaign = {};  // for a yield
  std::optional<long> devices = {};                    // of the campaign
  std::string program_version = {}, git_revision = {};
  ProcessLimits limits = {};
};

/// A file that a result depends on.
struct InputFile {
  std::string group;  // "device", ...; names in a file are of its group
  std::filesystem::path path;
  std::optional<std::string> text = {};  // in place of one on the disk
};

/// A result and the evidence that it is drawn from.
struct CompletedValidation {
  ValidationResult result;
  DeviceEvidence evidence;
};

/// A request whose files have been read and checked.
class Validator {
 public:
  /// Reads every file. Throws std::invalid_argument as read_qualification(),
  /// load_device(), read_specification_file(), CampaignPlan::read(),
  /// read_model() and open_tested_compensator(), and when
  /// - a model is to be trained and the qualification has no training runs;
  /// - a limit is relative to a baseline, and there are none of them either.
  explicit Validator(ValidationRequest request);
  ~Validator();
  Validator(Validator&&) noexcept;

  const ValidationRequest& request() const;
  /// Returns every file that the result depends on; one of two groups twice.
  const std::vector<InputFile>& inputs() const;

  /// Simulates the qualification for the device, or reads the recordings, and
  /// judges the compensator; does so with the devices of the campaign, if there
  /// is one. Of a set every device is judged; the verdict is the worst of them,
  /// and the result that of the first device with it. The result does not
  /// depend on the number of threads.
  CompletedValidation validate(std::size_t threads,
                               const ProgressOfWork& progress = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beamgyro::internal
