// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/run_source.h"
#include "validation/external/tested_compensator.h"
#include "validation/result/device_evidence.h"

namespace beamgyro::internal {

/// Who answers recordings, and how.
struct RecordedAnswering {
  const TestedCompensator& compensator;
  // What is known of it, null for a library or a command. The baselines "cubic"
  // and "straight_lines" are those in its file; there are no straight lines
  // where its training held no two soaks. "constant" is the mean of the cubic
  // over the temperatures that training saw.
  const FittedCompensator* known = nullptr;
  // [deg/s]; without, that of the first recording which tells it, or kFullScale
  std::optional<double> full_scale = {};
  bool requires_provenance = false;  // a compensator without one fails
};

/// Returns a recording by its number, with its name and hash, and adds what is
/// to be warned of.
using RecordingReader =
    std::function<TrainingRun(std::size_t k, std::vector<std::string>* warned)>;

/// Reads `count` recordings with `read` and answers them. Each shows its
/// recorded_purpose(); one at rest is read from kRestBegins on. Throws
/// std::invalid_argument that names a recording which cannot be read, or has no
/// true_rate.
DeviceEvidence recorded_evidence(std::size_t count,
                                 const RecordedAnswering& answering,
                                 std::size_t threads,
                                 const RecordingReader& read,
                                 std::vector<std::string>& warnings);

/// The same of runs of one device of a set.
DeviceEvidence recorded_evidence(std::vector<TrainingRun> runs,
                                 const RecordedAnswering& answering,
                                 std::size_t threads);

}  // namespace beamgyro::internal
