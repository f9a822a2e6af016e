// SPDX-License-Identifier: MIT
#include "compensation/validation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/rate_injection.h"

namespace beamgyro {
namespace {

struct MeasuredScaleFactor {
  std::string where;
  double value;      // [-]
  double tolerance;  // [-]
};

bool within(const MeasuredScaleFactor& measured) {
  return std::abs(measured.value - 1.0) <= measured.tolerance;
}

/// Every scale factor the verdict looks at.
std::vector<MeasuredScaleFactor> measured_scale_factors(
    const Validation& validation, const Specification& specification) {
  std::vector<MeasuredScaleFactor> all;
  const auto add = [&](const std::string& where,
                       const std::optional<ScaleFactor>& found,
                       double tolerance) {
    if (found) {
      const double value =
          validation.corrects_scale_factor ? found->slope : found->retained;
      all.push_back({where, value, tolerance});
    }
  };
  const Score& overall = validation.overall;
  const double tolerance = specification.scale_factor_tolerance;
  add("over every rate", overall.every_rate, tolerance);
  add(fmt::format("within {} deg/s", kSmallRate), overall.small_rates,
      specification.small_rate_tolerance);
  for (const Score& run : validation.runs) {
    if (run.every_rate && run.every_rate->largest_departure >= kTableRate) {
      add("in run " + run.run, run.every_rate, tolerance);
    }
  }
  if (overall.injected_scale_factor) {
    all.push_back(
        {"replayed at rest", *overall.injected_scale_factor, tolerance});
  }
  return all;
}

Check finite_check(const Score& overall) {
  return {"finite", overall.not_finite == 0,
          fmt::format("{} of {} answers are not finite, must be none",
                      overall.not_finite, overall.samples)};
}

Check scale_factor_check(const std::vector<MeasuredScaleFactor>& all) {
  if (all.empty()) {
    return {"scale factor", false,
            "not tested: no run varies its true rate by "
            "0.1 deg/s and none could be replayed"};
  }
  const auto worst =
      std::ranges::max_element(all, {}, [](const auto& measured) {
        const double off = std::abs(measured.value - 1.0) / measured.tolerance;
        return std::isnan(off) ? HUGE_VAL : off;
      });
  return {"scale factor", within(*worst),
          fmt::format("{:.6f} {}, must be 1 within {:g}", worst->value,
                      worst->where, worst->tolerance)};
}

Check residual_check(const Score& overall) {
  return {"residual", overall.residual.rms < overall.raw.rms,
          fmt::format("{:.4g} deg/s rms, must be below the {:.4g} deg/s of the "
                      "raw rate",
                      overall.residual.rms, overall.raw.rms)};
}

Verdict judge(const Validation& validation,
              const std::vector<MeasuredScaleFactor>& all) {
  if (validation.overall.not_finite > 0) {
    return Verdict::kNotFinite;
  }
  if (std::ranges::any_of(all, [](const MeasuredScaleFactor& measured) {
        return measured.value < kCancelledBelow;
      })) {
    return Verdict::kCancelsRate;
  }
  if (!std::ranges::all_of(all, within)) {
    return Verdict::kBendsScaleFactor;
  }
  if (all.empty()) {
    return Verdict::kScaleFactorUntested;
  }
  return residual_check(validation.overall).passed ? Verdict::kKeepsRate
                                                   : Verdict::kRemovesNoDrift;
}

}  // namespace

std::string verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kKeepsRate:
      return "keeps the rate";
    case Verdict::kNotFinite:
      return "not finite";
    case Verdict::kCancelsRate:
      return "cancels the rate";
    case Verdict::kBendsScaleFactor:
      return "bends the scale factor";
    case Verdict::kScaleFactorUntested:
      return "scale factor not tested";
    case Verdict::kRemovesNoDrift:
      return "removes no drift";
  }
  throw std::logic_error("verdict: not one of the enumerators");
}

bool Validation::passed() const {
  return std::ranges::all_of(checks, &Check::passed);
}

Validation validate(const std::string& method,
                    const std::vector<AnsweredRun>& runs,
                    const Specification& specification,
                    bool corrects_scale_factor) {
  if (runs.empty()) {
    throw std::invalid_argument("runs: none, must be one or more to validate");
  }
  std::vector<ScoredRun> scored;
  for (const AnsweredRun& run : runs) {
    scored.push_back(score_run(run));
  }

  Validation validation;
  validation.method = method;
  validation.corrects_scale_factor = corrects_scale_factor;
  validation.overall = score_together(scored);
  for (ScoredRun& run : scored) {
    validation.runs.push_back(std::move(run.score));
  }
  const auto all = measured_scale_factors(validation, specification);
  validation.checks = {finite_check(validation.overall),
                       scale_factor_check(all),
                       residual_check(validation.overall)};
  validation.verdict = judge(validation, all);
  return validation;
}

namespace {

AnsweredRun answered_run(const Compensator& compensator,
                         const NamedRecording& named) try {
  const Recording& recording = *named.recording;
  const auto estimator = [&compensator](const Recording& any) {
    return compensated_rate(compensator, any);
  };
  AnsweredRun run{.name = named.name,
                  .recording = &recording,
                  .compensated = estimator(recording),
                  .baseline = baseline_rate(compensator, recording)};
  if (!scale_factor(slope_sums(recording, run.compensated))) {
    // Replayed rates have the nominal scale factor, so none is to be corrected.
    Compensator bias_only = compensator;
    bias_only.scale_factor.reset();
    run.injected_scale_factor = injected_scale_factor(
        [&bias_only](const Recording& any) {
          return compensated_rate(bias_only, any);
        },
        recording);
  }
  return run;
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("{}: {}", named.name, error.what()));
}

}  // namespace

Validation validate(const Compensator& compensator, const std::string& method,
                    const std::vector<NamedRecording>& runs,
                    const Specification& specification) {
  std::vector<AnsweredRun> answered;
  for (const NamedRecording& run : runs)
    answered.push_back(answered_run(compensator, run));
  return validate(method, answered, specification,
                  compensator.scale_factor.has_value());
}

}  // namespace beamgyro
