// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator.h"
#include "compensation/score.h"
#include "dataset/recording.h"

namespace beamgyro {

/// What a compensator has to hold.
struct Specification {
  double scale_factor_tolerance = 1e-3;  // [-], |scale factor - 1|
  double small_rate_tolerance = 1e-2;    // [-], the same within kSmallRate: the
                                         // drift along a plateau weighs more
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

  bool passed() const;  // every check
};

constexpr double kCancelledBelow = 0.5;  // [-], scale factor

/// Scores the answers and judges them by the first line that applies:
///
///   not finite               a powered sample has no finite answer
///   cancels the rate         a scale factor below kCancelledBelow: within
///                            kSmallRate, over every rate, or in a replay at
///                            rest
///   bends the scale factor   off by more than its tolerance: within
///   kSmallRate;
///                            over every rate, of all runs together and of each
///                            whose rate departs by kTableRate; in a replay
///   scale factor not tested  no run varies its rate and none was replayed
///   removes no drift         rms of the residual not below that of the raw
///   rate keeps the rate
///
/// The scale factor is the one retained, or with `corrects_scale_factor` the
/// absolute slope. A limit is met only by a number: NaN fails it. Throws
/// std::invalid_argument without runs and as score_run().
Validation validate(const std::string& method,
                    const std::vector<AnsweredRun>& runs,
                    const Specification& specification = {},
                    bool corrects_scale_factor = false);

struct NamedRecording {
  std::string name;
  const Recording* recording;  // not owned
};

/// The same of a compensator's own answers, with the cubic it carries, and with
/// a replay (injected_scale_factor()) of each run whose true rate does not
/// vary.
Validation validate(const Compensator& compensator, const std::string& method,
                    const std::vector<NamedRecording>& runs,
                    const Specification& specification = {});

}  // namespace beamgyro
