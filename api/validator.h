// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "include/beamgyro/validate.h"
#include "validation/bundle/bundle.h"
#include "validation/external/compensator_source.h"
#include "validation/result/device_evidence.h"
#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// A result and the evidence that it is drawn from.
struct CompletedValidation {
  ValidationResult result;
  DeviceEvidence evidence;
};

/// A validation whose files have been read and checked, each of them once.
class Validator {
 public:
  /// Reads every file. Recordings are only hashed here, and read by
  /// validate(); `keeps_inputs` holds their bytes in memory for a bundle.
  /// Throws std::invalid_argument as require_sound(), read_qualification(),
  /// read_specification_file(), Campaign::read(), and when
  /// - a model is to be trained and the qualification has no training runs;
  /// - a limit is relative to a baseline, and there are none of them either;
  /// - a library or a command cannot be isolated as the options ask, see
  ///   isolation_of_command().
  Validator(CompensatorSource source, ValidationOptions options,
            bool keeps_inputs = false);
  ~Validator();

  const CompensatorSource& source() const;
  const ValidationOptions& options() const;
  /// Returns every file that the result depends on; one of two groups twice.
  const std::vector<ValidationInput>& inputs() const;

  /// Simulates the qualification for the device, or reads the recordings, and
  /// judges the compensator; does so with the devices of the campaign, if there
  /// is one. Of a set every device is judged; the verdict is the worst of them,
  /// and the result that of the first device with it. The result does not
  /// depend on the number of threads. Throws std::runtime_error when a file has
  /// changed since it was read first.
  CompletedValidation validate(std::size_t threads,
                               const ProgressOfWork& progress = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Validates on the threads that the options ask for, and tells `progress`.
ValidationOutcome validated(const Validator& validator,
                            const beamgyro::Progress& progress);

/// What a bundle asks for.
struct BundledRequest {
  std::string compensator;
  ValidationOptions options;
};

/// Returns it, with the paths of the copies. Throws std::invalid_argument for
/// one that no call could make.
BundledRequest request_of(const Bundle& bundle);

/// Returns the bundle's content of a validation.
BundleContent bundle_content(const Validator& validator);

}  // namespace beamgyro::internal
