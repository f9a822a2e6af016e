// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/document.h"
#include "dataset/set/source_copies.h"
#include "sim/campaign/draw_plan.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_file.h"
#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// A scenario that every qualified device goes through.
struct QualificationRun {
  std::string name;                        // [a-z][a-z0-9_]*
  RunPurpose purpose = RunPurpose::kSoak;  // not used of training runs
  double from = 0;             // [s], metrics read the run from here on
  ScenarioPlan scenario;       // its device is not used
  std::string scenario_text;   // byte for byte as read
  std::string overrides_text;  // one KEY=VALUE per line
  std::optional<ConfigDocument> document;  // the scenario with its overrides
  DrawPlan vary;                           // its keys that a seed draws
};

/// Names of the runs that a metric reads, by its name; a metric that is not
/// there reads every run of its purposes.
using MetricRuns = std::map<std::string, std::vector<std::string>, std::less<>>;

/// The contents of a qualification file: the runs that evidence is taken from,
/// and those that the baselines and a model are trained on.
struct Qualification {
  std::string name, description;
  std::vector<QualificationRun> runs;
  std::vector<QualificationRun> training;  // fitted
  std::vector<QualificationRun> held_out;  // a network stops early on them
  std::vector<QualificationRun> turning;   // fitted for the scale factor
  MetricRuns metric_runs;
  std::string text;               // byte for byte as read
  std::vector<SourceText> files;  // all that were read
  ProfileTables profiles;         // those of the scenarios
};

}  // namespace beamgyro::internal
