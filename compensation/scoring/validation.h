// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/scoring/score.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Limits that a compensator has to meet.
struct Specification {
  double scale_factor_tolerance = 1e-3;  // [-], |scale factor - 1|
  double small_rate_tolerance = 1e-2;    // [-], the same within kSmallRate: the
                                         // drift along a plateau weighs more
  std::optional<double> full_scale = {};  // [deg/s], largest rate replayed
};

enum class Verdict {
  kKeepsRate,            // "keeps the rate"
  kNotFinite,            // "not finite"
  kCancelsRate,          // "cancels the rate"
  kBendsScaleFactor,     // "bends the scale factor"
  kScaleFactorUntested,  // "scale factor not tested"
  kRemovesNoDrift,       // "removes no drift"
};

std::string verdict_text(Verdict verdict);

struct Check {
  std::string name;
  bool passed;
  std::string found;  // the figures met and the ones asked for
};

struct Validation {
  std::string method;
  bool corrects_scale_factor = false;
  std::vector<Score> runs;
  Score overall;
  std::vector<Check> checks;  // "finite", "scale factor", "residual"
  Verdict verdict = Verdict::kNotFinite;
  std::vector<std::string> warnings;  // of in-sample runs, of clamping

  bool passed() const;  // every check
};

/// Returns which of "constant" and "cubic", fitted to the scored runs
/// themselves, leave less than the compensator.
std::vector<std::string> better_fits(const Score& score);

/// Scores the answers and judges them by the first verdict that applies:
///
/// - not finite: a powered sample has no finite answer.
/// - cancels the rate: a scale factor is below kCancelledBelow.
/// - bends the scale factor: one is off by more than its tolerance.
/// - scale factor not tested: no run varies its rate and none was replayed, or
///   neither a replay nor a recorded rate tells what the compensator does.
/// - removes no drift: the rms of the residual is not below that of the raw
///   rate.
/// - keeps the rate.
///
/// The scale factors judged are those within kSmallRate and over every rate: of
/// all runs together, of each run whose rate departs by kTableRate, and of the
/// worst block of each replay (ReplayedScaleFactor).
///
/// The scale factor is the one retained, or with `corrects_scale_factor` the
/// absolute slope. NaN meets no limit. Throws std::invalid_argument without
/// runs and as score_run().
Validation validate(const std::string& method,
                    const std::vector<AnsweredRun>& runs,
                    const Specification& specification = {},
                    bool corrects_scale_factor = false);

struct NamedRecording {
  std::string name;
  const Recording* recording;  // not owned
  std::string sha256 = {};     // of its file, if it has one of its own
};

/// Validates the answers of a compensator, with the cubic in its file and with
/// replayed_scale_factor() of each run up to full scale (that of
/// `specification`, else stated_full_scale(), else kFullScale). Adds warnings
/// about runs that training used and about temperatures that it never saw.
Validation validate(const Compensator& compensator, const std::string& method,
                    const std::vector<NamedRecording>& runs,
                    const Specification& specification = {});

}  // namespace beamgyro::internal
