// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/run_source.h"
#include "dataset/recording/recording.h"
#include "validation/checks/declared_response.h"
#include "validation/evidence/evidence.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// A run as the compensator answered it.
struct CheckedRun {
  std::string name;
  RunPurpose purpose = RunPurpose::kSoak;
  const Recording* recording = nullptr;   // not owned; with its true_rate
  Answer answer = {};                     // to the recording as it is
  std::string sha256 = {};                // of its file, if it has one
  std::string device = {}, set_run = {};  // of a set: whose run, and which one
  bool is_limited = false;  // a limit is on a metric that reads it
};

/// What is checked.
struct CheckedCompensator {
  const TestedCompensator* compensator = nullptr;  // not owned
  std::vector<CheckedRun> runs;
  double full_scale = 150.0;  // [deg/s]
  // What the compensator says of its training, where it says anything.
  const Provenance* provenance = nullptr;  // not owned
  bool requires_provenance = false;        // it has to say something
  // The same compensator as training wrote it, if it is one of a file.
  const FittedCompensator* trained = nullptr;  // not owned
  const TrainingSet* set =
      nullptr;                     // of the runs that have a device; not owned
  DeclaredResponse declared = {};  // what its maker states of its answers
};

enum class CheckOutcome {
  kPassed,
  kFailed,
  kNotTested,  // no run shows it
};

constexpr CheckOutcome passed_if(bool passed) {
  return passed ? CheckOutcome::kPassed : CheckOutcome::kFailed;
}

/// What a check found.
struct CheckResult {
  std::string name = {};  // plain words with underscores
  CheckOutcome outcome = CheckOutcome::kNotTested;
  // The figure behind the outcome and its limit. No value that depends on the
  // speed of the machine, so that the same inputs give the same report.
  std::optional<double> value = {}, limit = {};
  std::string words = {};  // one sentence for a user

  bool passed() const { return outcome == CheckOutcome::kPassed; }
};

/// A check against compensators that only look good (docs/reference/checks).
struct CheckDefinition {
  std::string_view name;
  std::string_view figure;  // what CheckResult::value is, with its unit
  // What a user does next where it failed, and the run that would test it.
  std::string_view mend, test;
  // Whether a compensator passes as a whole without this check having been
  // tested: one that names no training cannot be held against it, and a
  // function of a program shares its processor with others.
  bool may_be_untested = false;
};

/// Returns every check, in the order of reports.
std::span<const CheckDefinition> check_definitions();

/// Runs every check, in the order of check_definitions(). Answers to altered
/// recordings are computed on `threads` threads; the results do not depend on
/// their number. Throws what the compensator throws for a recording that lacks
/// its inputs.
std::vector<CheckResult> run_checks(const CheckedCompensator& checked,
                                    std::size_t threads = 1);

/// Returns what a result is of. Throws std::invalid_argument for a name that is
/// not that of a check.
const CheckDefinition& definition_of(const CheckResult& result);

/// Whether a check that was not tested leaves a verdict as it is.
bool may_be_untested(const CheckResult& result);

/// Returns kFailed if one check failed, else kNotTested if one that must be
/// tested was not, else kPassed.
CheckOutcome outcome_of(const std::vector<CheckResult>& results);

}  // namespace beamgyro::internal
