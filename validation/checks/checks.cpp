// SPDX-License-Identifier: MIT
#include "validation/checks/checks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "validation/checks/check_context.h"
#include "validation/checks/random_response.h"

namespace beamgyro::internal {

namespace {

// Checks run stage by stage.
enum class Stage {
  kReset,       // whether two answers can be compared at all
  kConduct,     // may make the answers unfit for comparison
  kComparison,  // compare answers with each other or with the truth
  kFaults,      // report what was seen of faults, also in altered recordings
};

struct CheckRow {
  CheckDefinition definition;
  CheckFunction run;
  Stage stage = Stage::kComparison;
};

constexpr const char* kWithoutRate =
    "train without inputs that hold the rate (rate, output), or with "
    "rate_penalty";
constexpr const char* kWithoutNoise =
    "train without inputs that hold the rate (rate, output); where noise "
    "rises, with bp.weight_decay = 1e-6 or the input temperature_play(2)";
constexpr const char* kTurningRun =
    "a run whose rate changes, such as a rate table";

constexpr std::array kChecks{
    CheckRow{{"jacobian", "largest departure from 1 of d(answer)/d(rate) [-]",
              kWithoutRate, kTurningRun},
             check_jacobian},
    CheckRow{{"injection",
              "largest departure from 1 of the share of an added rate that "
              "comes out [-]",
              kWithoutRate, "rate tables over the temperatures of the runs"},
             check_injection},
    CheckRow{{"true_rate",
              "largest departure from 1 of the scale factor kept on a rate "
              "table [-]",
              kWithoutRate, "rate tables of 11 rates at 5 temperatures"},
             check_true_rate},
    CheckRow{{"allan_fingerprint",
              "departure from 1 of the Allan deviation at 1 s, after over "
              "before [-]",
              kWithoutNoise, "a run of some minutes at rest, with its noise"},
             check_allan_fingerprint},
    CheckRow{{"shuffled_output",
              "change of the correction over change of the output when the "
              "output is shuffled [-]",
              kWithoutRate, kTurningRun},
             check_shuffled_output},
    CheckRow{{"rate_correlation",
              "share of the true rate that the correction follows [-]",
              kWithoutRate, "a run with random rates"},
             check_rate_correlation},
    CheckRow{{"hold_out", "runs that training used",
              "validate on runs that training has not seen (other seeds, other "
              "temperatures), a compensator that names its training",
              "a compensator file, which names its training", true},
             check_hold_out,
             Stage::kFaults},
    CheckRow{{"extrapolation",
              "samples at temperatures that training has not seen [%]",
              "train over the temperatures of these runs",
              "a compensator file, which names its temperatures", true},
             check_extrapolation,
             Stage::kFaults},
    CheckRow{{"temperature_input",
              "share of the temperature that is noise or does not follow the "
              "gyro [-]",
              "look at the temperature of the runs: its sensor, its unit, its "
              "column",
              "runs over more than 2 K", true},
             check_temperature_input,
             Stage::kFaults},
    CheckRow{
        {"causality", "runs whose answers use what follows",
         "answer each sample from it and those before", "a run of 100 samples"},
        check_causality,
        Stage::kConduct},
    CheckRow{{"answers", "runs that are not answered as they must be",
              "mend what the sentence names", "any run"},
             check_answers,
             Stage::kFaults},
    CheckRow{{"finite", "powered samples without a finite answer",
              "answer every powered sample", "any run"},
             check_finite,
             Stage::kFaults},
    CheckRow{{"reset", "runs answered otherwise after a reset",
              "forget everything at a reset", "a run of 100 samples"},
             check_reset,
             Stage::kReset},
    CheckRow{{"declared", "", "declare what the answers are like",
              "a specification with [declared]", true},
             check_declared},
    CheckRow{{"output_stuck",
              "longest time with the same answer while the output changes [s]",
              "look at where the answers stay the same", kTurningRun},
             check_output_stuck,
             Stage::kConduct},
    CheckRow{{"real_time", "", "make it faster, or validate on an idle machine",
              "a library or a command", true},
             check_real_time,
             Stage::kFaults}};

constexpr std::array<std::string_view, 6> kExplainedByResponse = {
    "jacobian",          "injection", "shuffled_output",
    "allan_fingerprint", "finite",    "output_stuck"};

constexpr const char* kTooFewAnswers =
    "Too many answers are missing: see the checks \"answers\" and \"finite\".";

/// Returns why answers cannot be compared, or an empty text when they can.
std::string obstacle_to_comparison(const CheckContext& context,
                                   const std::vector<CheckResult>& results) {
  if (!context.answered()) return kTooFewAnswers;
  for (const CheckResult& result : results)
    if (result.outcome == CheckOutcome::kFailed)
      return fmt::format("See the check \"{}\" first.", result.name);
  return "";
}

// Names, in the first check that failed by the response to added rates, the
// declaration with which it would not.
void suggest_declaration(const CheckContext& context,
                         std::vector<CheckResult>& results) {
  if (!context.declared().empty() || context.checked.trained != nullptr) return;
  const auto failed = std::ranges::find_if(results, [](const CheckResult& one) {
    return one.outcome == CheckOutcome::kFailed &&
           std::ranges::count(kExplainedByResponse, one.name) > 0;
  });
  if (failed == results.end()) return;
  if (const auto declared = possible_declaration(context))
    failed->words += fmt::format(
        " With [declared] {} in the specification this would pass: declare it "
        "where it is intended.",
        declared->words());
}

}  // namespace

std::span<const CheckDefinition> check_definitions() {
  static const auto kDefinitions = [] {
    std::array<CheckDefinition, kChecks.size()> all;
    std::ranges::transform(kChecks, all.begin(), &CheckRow::definition);
    return all;
  }();
  return kDefinitions;
}

std::vector<CheckResult> run_checks(const CheckedCompensator& checked,
                                    std::size_t threads) {
  CheckContext context(checked, threads);
  std::vector<CheckResult> results(kChecks.size());
  const auto run_stage = [&](Stage stage, const std::string& obstacle) {
    for (std::size_t k = 0; k < kChecks.size(); ++k) {
      if (kChecks[k].stage != stage) continue;
      results[k] =
          obstacle.empty() ? kChecks[k].run(context) : not_tested(obstacle);
      results[k].name = kChecks[k].definition.name;
    }
  };
  run_stage(Stage::kReset, context.answered() ? "" : kTooFewAnswers);
  run_stage(Stage::kConduct, obstacle_to_comparison(context, results));
  const std::string obstacle = obstacle_to_comparison(context, results);
  if (obstacle.empty()) context.random = random_response(context);
  run_stage(Stage::kComparison, obstacle);
  run_stage(Stage::kFaults, "");
  suggest_declaration(context, results);
  return results;
}

const CheckDefinition& definition_of(const CheckResult& result) {
  const auto& all = check_definitions();
  const auto found =
      std::ranges::find(all, result.name, &CheckDefinition::name);
  if (found == all.end())
    throw std::invalid_argument(
        fmt::format("\"{}\": is not the name of a check", result.name));
  return *found;
}

bool may_be_untested(const CheckResult& result) {
  return definition_of(result).may_be_untested;
}

CheckOutcome outcome_of(const std::vector<CheckResult>& results) {
  bool tested = true;
  for (const CheckResult& result : results) {
    if (result.outcome == CheckOutcome::kFailed) return CheckOutcome::kFailed;
    tested = tested && (may_be_untested(result) || result.passed());
  }
  return tested ? CheckOutcome::kPassed : CheckOutcome::kNotTested;
}

}  // namespace beamgyro::internal
