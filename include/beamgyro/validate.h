// SPDX-License-Identifier: MIT
/// \file
/// Validation: whether a compensator removes the drift and keeps the rate.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "beamgyro/compensator.h"
#include "beamgyro/device.h"
#include "beamgyro/progress.h"
#include "beamgyro/set.h"
#include "beamgyro/train.h"
#include "beamgyro/verdict.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

constexpr std::uint64_t kLargestSeed = (std::uint64_t{1} << 53) - 1;

/// Returns a seed that nobody can know before, from the operating system. It is
/// below 2^52, so that seeds may follow it.
std::uint64_t random_seed();

/// A run as a metric of the user's own reads it. The recording and the rate
/// stay as long as the metric is evaluated.
struct OwnMetricRun {
  std::string name;
  std::string purpose;         ///< "soak", "ramp", ...
  const Recording& recording;  ///< with its true_rate
  /// [deg/s], one per time: the recorded or the compensated rate; NaN: none.
  const std::vector<double>& rate;
};

/// A metric of the user's own, without an interval. What its function throws
/// ends validate().
struct OwnMetric {
  std::string name;  ///< a letter, then letters, digits and _; none of ours
  std::string unit;  ///< printable ASCII; 1: none
  /// Returns its value; NaN: none. It is called with the recorded, then with
  /// the compensated rate of all runs; by several threads with `seeds`.
  std::function<double(const std::vector<OwnMetricRun>&)> value;
};

/// What a compensator is judged on and by: `device`, recordings or `set`.
/// The command and Python take the same members under the names of
/// docs/reference/commands.md and docs/guide/python.md.
struct ValidationOptions {
  std::optional<Device> device = {};
  /// The runs that it goes through; that of a device only.
  std::optional<std::filesystem::path> qualification = {};
  std::vector<std::filesystem::path> recordings = {};  ///< files
  /// Recordings that are judged after those files. In the result the checksums
  /// of what was measured stand in place of those of files.
  std::vector<NamedRecording> recordings_in_memory = {};
  std::optional<Set> set = {};
  std::vector<std::string> runs = {};  ///< of the set; none: all
  /// Numbers of the set; none: the test devices.
  std::vector<std::uint32_t> devices = {};
  /// Limits (docs/reference/specification_file.md); without them those of
  /// specs/default.toml count.
  std::optional<std::filesystem::path> specification = {};
  /// A table of metrics of the user's own (docs/reference/own_metrics.md). Not
  /// with `against`, `seeds` or a campaign: its figures are of one compensator
  /// on one set of runs.
  std::optional<std::filesystem::path> own_metrics = {};
  /// Functions for such metrics. Not with a campaign.
  std::vector<OwnMetric> metrics = {};
  /// A compensator file that the answers are compared with.
  std::optional<std::filesystem::path> workbench = {};
  /// A compensator file that is judged on the same runs, beside the first.
  std::optional<std::filesystem::path> against = {};
  /// A result of an earlier validation (`--json`), than which this one must not
  /// be worse.
  std::optional<std::filesystem::path> baseline_result = {};
  /// A campaign whose devices are judged, too, for a yield; how many of them.
  std::optional<std::filesystem::path> campaign = {};
  std::optional<std::uint32_t> campaign_devices = {};
  /// Draws noise, random rates, the order and the lengths and temperatures of
  /// runs, and the devices of a campaign anew, at most kLargestSeed; none: the
  /// qualification as its file says, which anybody can know. Of a device only.
  std::optional<std::uint64_t> seed = {};
  /// Judges with so many seeds in a row, from `seed` or else from 1 on, at most
  /// 10000. The verdict is the worst of them. Not with a campaign.
  std::optional<std::uint32_t> seeds = {};
  std::optional<double> full_scale = {};  ///< [deg/s], above 0; not of a device
  /// Whether a compensator that does not say what it was trained on fails.
  bool require_provenance = false;
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
  bool met_before = false;       ///< the recorded rate meets it, too
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
  std::string words;               ///< the reason, in a sentence or two
  std::string next;                ///< what to do next
  std::vector<MetricRow> metrics;  ///< those of the user's own stand last
  std::vector<CheckRow> checks;
  std::vector<std::string> warnings;
  std::string text;         ///< what `beamgyro validate` prints
  std::string all_metrics;  ///< the same with every metric: `--all-metrics`
  std::string json;         ///< what `--json` writes
  std::string page;         ///< HTML, what `--report` writes
  std::string junit;        ///< XML, what `--junit` writes
  std::string lines;        ///< a line for each case of it: `--lines`
  /// Of a model: the compensator that was trained and judged, as
  /// `--save-trained` writes it; else empty.
  std::string trained;
};

/// Judges a compensator by every metric, check and limit. The result does not
/// depend on the number of threads. A class of the user's own is called by
/// several threads at once. Throws std::invalid_argument for what is wrong in a
/// file or missing among the options, for a recording that is there twice, for
/// one in memory that write_recording() would refuse, and
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
