// SPDX-License-Identifier: MIT
/// \file
/// Validation: whether a compensator removes the drift and keeps the rate.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "beamgyro/compensator.h"
#include "beamgyro/device.h"
#include "beamgyro/progress.h"
#include "beamgyro/set.h"
#include "beamgyro/train.h"
#include "beamgyro/verdict.h"

namespace beamgyro {

/// What a compensator is judged on and by: `device`, `recordings` or `set`.
/// The command and Python take the same members under the names of
/// docs/reference/commands.md and docs/guide/python.md.
struct ValidationOptions {
  std::optional<Device> device = {};
  /// The runs that it goes through; that of a device only.
  std::optional<std::filesystem::path> qualification = {};
  std::vector<std::filesystem::path> recordings = {};
  std::optional<Set> set = {};
  std::vector<std::string> runs = {};  ///< of the set; none: all
  /// Numbers of the set; none: the test devices.
  std::vector<std::uint32_t> devices = {};
  /// Limits (docs/reference/specification_file.md); without them those of
  /// specs/default.toml count.
  std::optional<std::filesystem::path> specification = {};
  /// A compensator file that the answers are compared with.
  std::optional<std::filesystem::path> workbench = {};
  /// A campaign whose devices are judged, too, for a yield; how many of them.
  std::optional<std::filesystem::path> campaign = {};
  std::optional<std::uint32_t> campaign_devices = {};
  std::optional<double> full_scale = {};  ///< [deg/s], above 0; not of a device
  /// Files and folders that a library or a command may read beside those of
  /// the system and the scripts that it names. What it is judged by is never
  /// among them (docs/reference/plugins.md).
  std::vector<std::filesystem::path> plugin_files = {};
  /// Judges no code of others that is not isolated from what it is judged by.
  bool require_isolation = false;
  unsigned jobs = 0;  ///< threads; 0: one per core
  Progress progress = {};
};

/// A figure with its interval of 95 %; the bounds are NaN where there is none.
struct IntervalEstimate {
  double value, low, high;
};

/// A limit that a specification sets, and what was decided.
struct LimitResult {
  std::string words;  ///< "at most 0.1", "0.98 to 1.02"
  /// Empty, or "before", "constant", "cubic", "spline": of the metric divided
  /// by that of the recorded rate or of a baseline.
  std::string relative_to;
  Verdict result = Verdict::kUndecided;
  std::optional<double> margin;  ///< to the nearer limit, positive within
  std::string reason;            ///< one sentence
};

/// A metric of the recorded and of the compensated rate.
struct MetricRow {
  std::string name;    ///< as in specifications
  std::string unit;    ///< deg/s, s, ppm, ...
  std::string clause;  ///< of IEEE 1431, or empty
  std::optional<IntervalEstimate> before, after;
  std::vector<LimitResult> limits;  ///< of the specification
};

/// A check against compensators that only look good.
struct CheckRow {
  std::string name;
  std::string outcome;  ///< "passed", "failed" or "not tested"
  std::optional<double> value, limit;
  std::string words;  ///< one sentence
};

struct ValidationOutcome {
  Verdict verdict = Verdict::kUndecided;
  std::string words;  ///< the reason, in a sentence or two
  std::string next;   ///< what to do next
  std::vector<MetricRow> metrics;
  std::vector<CheckRow> checks;
  std::vector<std::string> warnings;
  std::string text;         ///< what `beamgyro validate` prints
  std::string all_metrics;  ///< the same with every metric: `--all-metrics`
  std::string json;         ///< what `--json` writes
  std::string page;         ///< HTML, what `--report` writes
};

/// Judges a compensator by every metric, check and limit. The result does not
/// depend on the number of threads. A class of the user's own is called by
/// several threads at once. Throws std::invalid_argument for what is wrong in a
/// file or missing among the options, for a recording that is there twice, and
/// as open_compensator() for the isolation, std::runtime_error when a
/// simulation or a process cannot go on, Cancelled, and what a class of the
/// user's own throws.
ValidationOutcome validate(const RateCompensator& compensator,
                           const ValidationOptions& options);

/// The same for a model, which is trained on the training runs of the
/// qualification; of a device only.
ValidationOutcome validate(const Model& model,
                           const ValidationOptions& options);

}  // namespace beamgyro
