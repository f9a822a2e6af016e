// SPDX-License-Identifier: MIT
#include "compensation/scoring/validation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/compensator/training_use.h"
#include "compensation/scoring/temperature_sweep.h"

namespace beamgyro::internal {
namespace {

constexpr double kSameRms = 1e-6;  // [-], of two rms: rounding

struct MeasuredScaleFactor {
  std::string where;
  double value;      // [-]
  double tolerance;  // [-]
};

bool within(const MeasuredScaleFactor& measured) {
  return std::abs(measured.value - 1.0) <= measured.tolerance;
}

ScaleFactorTolerance tolerance_of(const Specification& specification) {
  return {specification.scale_factor_tolerance,
          specification.small_rate_tolerance};
}

/// Returns every scale factor that the verdict depends on.
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
  const auto add_replayed = [&](const std::string& where,
                                const WorstBlocks& worst) {
    for (const auto& block : {worst.small, worst.large}) {
      if (block) {
        all.push_back(
            {fmt::format("replayed {} ({:.4g} deg/s, {:.1f} degC, {:.6g} s)",
                         where, block->rate, block->temperature, block->time),
             block->retained, tolerance_of(specification).at(block->rate)});
      }
    }
  };
  for (const Score& run : validation.runs) {
    if (run.replayed) {
      add_replayed("in run " + run.run, run.replayed->worst);
      add_replayed("over every temperature", run.replayed->over_temperature);
    }
  }
  if (overall.replayed && overall.replayed->worst_plateau) {
    all.push_back({"on the worst plateau with recorded rates",
                   *overall.replayed->worst_plateau,
                   specification.small_rate_tolerance});
  }
  return all;
}

Check finite_check(const Score& overall) {
  return {"finite", overall.not_finite == 0,
          fmt::format("{} of {} answers are not finite, must be none",
                      overall.not_finite, overall.samples)};
}

/// Returns why the scale factor was not tested, or an empty text when it was.
std::string why_untested(const Score& overall,
                         const std::vector<MeasuredScaleFactor>& all) {
  if (overall.replayed && !overall.replayed->untested.empty()) {
    const ReplayedScaleFactor& replayed = *overall.replayed;
    return fmt::format(
        "not tested: a replay cannot tell what {} does, and within {:g} K of "
        "{:.1f} degC no recorded rate does ({:g} deg/s or more at a steady "
        "temperature)",
        fmt::join(replayed.untested, ", "), kRateReach,
        replayed.untested_temperature, kLargeShare * replayed.full_scale);
  }
  return all.empty() ? "not tested: no run varies its true rate by 0.1 deg/s "
                       "and none could be replayed"
                     : "";
}

Check scale_factor_check(const Score& overall,
                         const std::vector<MeasuredScaleFactor>& all) {
  const std::string untested = why_untested(overall, all);
  if (!untested.empty() && std::ranges::all_of(all, within)) {
    return {"scale factor", false, untested};
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
  std::string found = fmt::format(
      "{:.4g} deg/s rms, must be below the {:.4g} deg/s of the raw rate; "
      "fitted to these runs a constant leaves {:.4g}",
      overall.residual.rms, overall.raw.rms, overall.constant.rms);
  if (overall.cubic) {
    found += fmt::format(", a cubic {:.4g}", overall.cubic->rms);
  }
  const std::vector<std::string> better = better_fits(overall);
  if (!better.empty()) {
    found += fmt::format(": worse than a {}", fmt::join(better, " and a "));
  }
  return {"residual", overall.residual.rms < overall.raw.rms, found};
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
  if (!why_untested(validation.overall, all).empty()) {
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

std::vector<std::string> better_fits(const Score& score) {
  std::vector<std::string> better;
  const auto is_better = [&score](const ResidualScores& fit) {
    return score.residual.rms > fit.rms * (1.0 + kSameRms);
  };
  if (is_better(score.constant)) {
    better.emplace_back("constant");
  }
  if (score.cubic && is_better(*score.cubic)) {
    better.emplace_back("cubic");
  }
  return better;
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
                       scale_factor_check(validation.overall, all),
                       residual_check(validation.overall)};
  validation.verdict = judge(validation, all);
  return validation;
}

namespace {

/// Runs `work` and puts the name of the run before an error.
template <class Work>
void for_run(const NamedRecording& named, const Work& work) try {
  work();
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("{}: {}", named.name, error.what()));
}

double full_scale_of(const Recording& recording,
                     const Specification& specification) {
  if (specification.full_scale) return *specification.full_scale;
  return stated_full_scale(recording).value_or(kFullScale);
}

/// Returns the answers of the compensator and of its baseline, and replays.
std::vector<AnsweredRun> answered_runs(const Compensator& compensator,
                                       const std::vector<NamedRecording>& runs,
                                       const Specification& specification) {
  std::vector<AnsweredRun> answered;
  RecordedRates rates;
  for (const NamedRecording& named : runs)
    for_run(named, [&] {
      const Recording& recording = *named.recording;
      answered.push_back(
          {.name = named.name,
           .recording = &recording,
           .compensated = compensated_rate(compensator, recording),
           .baseline = baseline_rate(compensator, recording)});
      if (needs_recorded_rates(compensator))
        add_recorded_rates(recording, answered.back().compensated,
                           full_scale_of(recording, specification), rates);
    });
  for (std::size_t k = 0; k < runs.size(); ++k)
    for_run(runs[k], [&] {
      AnsweredRun& run = answered[k];
      run.replayed =
          replayed_scale_factor(compensator, *run.recording, run.compensated,
                                full_scale_of(*run.recording, specification),
                                tolerance_of(specification), rates);
    });
  const auto any = std::ranges::find_if(answered, [](const AnsweredRun& run) {
    return run.replayed.has_value();
  });
  if (any != answered.end())
    any->replayed->over_temperature = worst_over_temperature(
        compensator, *any->recording, any->replayed->full_scale);
  return answered;
}

}  // namespace

Validation validate(const Compensator& compensator, const std::string& method,
                    const std::vector<NamedRecording>& runs,
                    const Specification& specification) {
  Validation validation =
      validate(method, answered_runs(compensator, runs, specification),
               specification, compensator.scale_factor.has_value());
  std::size_t seen = 0, clamped = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    Score& score = validation.runs[k];
    score.in_sample = was_used_in_training(compensator.provenance,
                                           runs[k].sha256, *runs[k].recording);
    seen += score.in_sample ? 1 : 0;
    clamped += clamped_samples(compensator, *runs[k].recording);
  }
  if (clamped > 0)
    validation.warnings.push_back(fmt::format(
        "{} samples lie outside {:g} to {:g} degC, the temperatures seen in "
        "training; clamped",
        clamped, compensator.temperature_range.lowest,
        compensator.temperature_range.highest));
  if (const std::string warning =
          warning_of_no_training(compensator.provenance);
      !warning.empty())
    validation.warnings.push_back(warning);
  if (seen > 0)
    validation.warnings.push_back(fmt::format(
        "{} of {} runs were used in training: these scores are in-sample and "
        "flatter the compensator",
        seen, runs.size()));
  return validation;
}

}  // namespace beamgyro::internal
