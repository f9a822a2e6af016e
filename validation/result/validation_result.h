// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "validation/metrics/metric.h"

namespace beamgyro {

/// The value of a metric that a baseline leaves.
struct BaselineEstimate {
  std::string name;  // "constant", "cubic", "spline"
  std::optional<Estimate> estimate;
};

/// A metric of the rate that was recorded (before) and of the compensated rate
/// (after).
struct MetricResult {
  const Metric* metric;  // of metrics()
  std::optional<Estimate> before, after;
  std::vector<BaselineEstimate> baselines = {};
};

/// A file that a result depends on.
struct ResultFile {
  std::string role;  // "compensator", "device", "qualification", "scenario"...
  std::string name;  // without its folder
  std::string sha256;
};

/// What was judged: its argument and what is known of it.
struct JudgedCompensator {
  std::string name;         // of the file without its ending, or the command
  std::string kind;         // "compensator", "library", "command", "model"
  std::string method = {};  // "BP network 2, 8", ... where it is known
  std::vector<std::string> inputs = {};  // the measured variables that it reads
};

/// The answer of the validator about one device.
struct ValidationResult {
  JudgedCompensator compensator;
  std::vector<MetricResult> metrics;
  std::string words;  // the verdict as a sentence
  std::vector<std::string> warnings;
  // Provenance.
  std::string program_version, git_revision;
  std::string device, qualification;  // names
  std::vector<ResultFile> files;
};

}  // namespace beamgyro
