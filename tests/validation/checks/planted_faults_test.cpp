// SPDX-License-Identifier: MIT
// Compensators with a known fault, checked on simulated runs.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "compensation/compensator/run_comparison.h"
#include "compensation/scoring/scale_factor.h"
#include "random/random_stream.h"
#include "sim/scenario/simulation.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"
#include "tests/validation/checks/simulated_runs.h"
#include "tests/validation/external/tested_run.h"
#include "validation/checks/check_context.h"
#include "validation/external/compensator_source.h"
#include "validation/metrics/metric.h"
#include "validation/specification/decision.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal::planted_faults_test {
namespace {

using Names = std::vector<std::string>;
using Function = FunctionCompensator::Function;

std::vector<double> sound(const Recording& run) {
  return compensated_rate(trained("spline"), run);
}

Names failed(const Function& function) {
  const FunctionCompensator compensator(function);
  return failed_checks(checked(compensator));
}

CheckResult result_of(const Function& function, const std::string& name) {
  const FunctionCompensator compensator(function);
  for (const CheckResult& result : run_checks(checked(compensator)))
    if (result.name == name) return result;
  throw std::invalid_argument(name + ": not a check");
}

// The answers of a sound compensator, changed.
Function changed(const std::function<void(std::vector<double>&)>& change) {
  return [change](const Recording& run) {
    std::vector<double> answers = sound(run);
    change(answers);
    return answers;
  };
}

// The recording with its temperatures changed.
template <class Change>
Recording with_temperature(Recording run, const Change& change) {
  for (Column& column : run.columns)
    if (column.name == "temperature")
      for (double& value : column.values) value = change(value);
  return run;
}

TEST(PlantedFaults, ASoundCompensatorPassesEveryCheck) {
  const FunctionCompensator compensator(sound);
  const auto results = run_checks(checked(compensator));
  for (const CheckResult& result : results)
    EXPECT_TRUE(result.passed() || may_be_untested(result))
        << result.name << ": " << result.words;
  EXPECT_EQ(outcome_of(results), CheckOutcome::kPassed);
}

TEST(PlantedFaults, TheNumberOfThreadsChangesNothing) {
  const FunctionCompensator compensator([](const Recording& run) {
    return compensated_rate(trained("output_and_temperature"), run);
  });
  const CheckedCompensator all = checked(compensator);
  const auto one = run_checks(all, 1), three = run_checks(all, 3);
  ASSERT_EQ(one.size(), check_definitions().size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].value, three[k].value) << one[k].name;
    EXPECT_EQ(one[k].words, three[k].words);
  }
}

// Trained at rest on output and temperature, the paper's inputs.
TEST(PlantedFaults, ANetworkThatEatsTheRate) {
  const auto network = [](const Recording& run) {
    return compensated_rate(trained("output_and_temperature"), run);
  };
  EXPECT_EQ(failed(network),
            (Names{"jacobian", "injection", "true_rate", "allan_fingerprint",
                   "shuffled_output", "rate_correlation"}));
}

// Its time constant of 100 s leaves white noise and rates of 1 Hz as they are.
TEST(PlantedFaults, AHighPassFilter) {
  const Function high_pass = changed([](std::vector<double>& answers) {
    double low = answers[0];
    for (double& value : answers) {
      low += (value - low) * 0.1 / 100.0;
      value -= low;
    }
  });
  EXPECT_EQ(failed(high_pass),
            (Names{"jacobian", "injection", "true_rate", "shuffled_output"}));
}

// The same as a program. Only the run at rest: 200,000 lines.
TEST(PlantedFaults, AHighPassFilterInACommand) {
  const auto file = std::filesystem::temp_directory_path() /
                    fmt::format("beamgyro high pass {}.py", ::getpid());
  std::ofstream(file) << R"(
import sys
rate = sys.stdin.readline().strip().split(",").index("rate")
low = None
for line in sys.stdin:
    value = float(line.split(",")[rate])
    low = value if low is None else low + (value - low) * 0.1 / 100
    print(value - low)
)";
  const auto compensator = open_tested_compensator(
      fmt::format("cmd:/usr/bin/python3 '{}'", file.string()), test_limits());
  const SimulatedRun& rest = simulated_runs().back();
  CheckedCompensator all;
  all.compensator = compensator.get();
  all.runs.push_back({.name = rest.name,
                      .purpose = rest.purpose,
                      .recording = &rest.recording,
                      .answer = compensator->answer(rest.recording)});
  EXPECT_EQ(failed_checks(all),
            (Names{"jacobian", "injection", "shuffled_output"}));
  std::filesystem::remove(file);
}

TEST(PlantedFaults, AScaleFactorThatIsOffByOnePercent) {
  const Function scaled = changed([](std::vector<double>& answers) {
    for (double& value : answers) value *= 0.99;
  });
  EXPECT_EQ(failed(scaled), (Names{"jacobian", "injection", "true_rate",
                                   "shuffled_output", "rate_correlation"}));
  EXPECT_NEAR(*result_of(scaled, "injection").value, 0.01, 1e-9);
}

TEST(PlantedFaults, ADelayOfATenthOfASecond) {
  const Function delayed = changed([](std::vector<double>& answers) {
    std::copy_backward(answers.begin(), answers.end() - 1, answers.end());
  });
  EXPECT_EQ(failed(delayed), Names{"injection"});
  EXPECT_TRUE(holds(result_of(delayed, "injection").words, "0.1 s late"));
}

TEST(PlantedFaults, AnOutputThatSticksAfterTenMinutes) {
  const Function sticks = changed([](std::vector<double>& answers) {
    for (std::size_t k = 6000; k < answers.size(); ++k)
      answers[k] = answers[5999];
  });
  EXPECT_EQ(failed(sticks), Names{"output_stuck"});
}

// The runs reach 50 degC, the file 55: there a table takes the rate away.
TEST(PlantedFaults, ATableOfScaleFactorsThatEatsTheRateBeyondTheRuns) {
  FittedCompensator table = trained("spline");
  const double beyond = table.temperature_range.highest - 1.5;
  const auto failed_with = [&](double s) {
    table.scale_factor = LookupTable{
        Eigen::ArrayXd{{-60.0, beyond - 0.2, beyond, beyond + 0.2, 80.0}},
        Eigen::ArrayXd{{1.0, 1.0, s, 1.0, 1.0}}};
    const auto compensator = tested(table);
    CheckedCompensator all = checked(*compensator);
    all.trained = &table;
    return failed_checks(all);
  };
  EXPECT_EQ(failed_with(1000.0), Names{"injection"});
  EXPECT_EQ(failed_with(5.0), Names{"injection"});
  EXPECT_EQ(failed_with(1.0), Names{});
}

// Its low-pass of the temperature has 30 degC in no run.
TEST(PlantedFaults, ARateThatIsEatenWhereALowPassArrives) {
  const Function eats = [](const Recording& run) {
    std::vector<double> answers = sound(run);
    const auto& T = column_values(run, "temperature");
    double low = T.empty() ? 0.0 : T[0];
    for (std::size_t k = 0; k < T.size(); ++k) {
      if (k > 0)
        low += -std::expm1(-(run.time[k] - run.time[k - 1]) / 2000.0) *
               (T[k] - low);
      if (std::abs(low - 30.0) < 0.15) answers[k] = 0.0;
    }
    return answers;
  };
  EXPECT_EQ(failed(eats), Names{"injection"});
}

TEST(PlantedFaults, StateThatIsKeptOverAReset) {
  const auto state = std::make_shared<double>(0.0);
  const Function keeps = changed([state](std::vector<double>& answers) {
    for (double& value : answers) {
      *state += 1e-3 * (value - *state);
      value += 1e-6 * *state;
    }
  });
  EXPECT_EQ(failed(keeps), Names{"reset"});
}

// It smooths over a minute and begins and ends with zero, as a convolution over
// the valid part does: short runs are all edge, long ones are not.
TEST(PlantedFaults, ADerivativeFromBothSides) {
  const auto centred = [](const Recording& run) {
    std::vector<double> answers = sound(run);
    const auto& T = column_values(run, "temperature");
    if (run.time.size() < 15000) return answers;
    for (std::size_t k = 300; k + 300 < answers.size(); ++k)
      answers[k] -= 0.01 * (T[k + 300] - T[k - 300]);
    return answers;
  };
  EXPECT_EQ(failed(centred), Names{"causality"});
}

// What it has learnt in long runs it keeps.
TEST(PlantedFaults, StateThatALongRunLeaves) {
  const auto learnt = std::make_shared<double>(0.0);
  const auto keeps = [learnt](const Recording& run) {
    std::vector<double> answers = sound(run);
    for (double& value : answers) value -= *learnt;
    if (run.time.back() > 1700.0) *learnt += 1e-5;
    return answers;
  };
  EXPECT_EQ(failed(keeps), Names{"reset"});
}

TEST(PlantedFaults, PeekingOneSampleAhead) {
  const Function peeks = changed([](std::vector<double>& answers) {
    std::copy(answers.begin() + 1, answers.end(), answers.begin());
  });
  EXPECT_EQ(failed(peeks), Names{"causality"});
}

TEST(PlantedFaults, NanOnceInAHundredThousandSamples) {
  const Function nan = changed([](std::vector<double>& answers) {
    if (answers.size() > 30000) answers[30000] = std::nan("");
  });
  EXPECT_EQ(failed(nan), Names{"finite"});
  EXPECT_EQ(result_of(nan, "finite").value, 1.0);
}

Recording first_samples(const Recording& run, std::size_t samples) {
  Recording part = run;
  part.time.resize(samples);
  part.status.resize(samples);
  for (Column& column : part.columns) column.values.resize(samples);
  return part;
}

TEST(PlantedFaults, RunsThatShowNothingFailNothing) {
  const FunctionCompensator compensator(sound);
  for (const std::size_t samples : {0U, 1U, 2U, 3U, 50U}) {
    const Recording run =
        first_samples(simulated_runs().back().recording, samples);
    CheckedCompensator all;
    all.compensator = &compensator;
    if (samples > 0)
      all.runs.push_back({.name = "short",
                          .purpose = RunPurpose::kRest,
                          .recording = &run,
                          .answer = compensator.answer(run)});
    const auto results = run_checks(all);
    EXPECT_EQ(outcome_of(results), CheckOutcome::kNotTested) << samples;
    for (const CheckResult& result : results)
      EXPECT_FALSE(result.words.empty()) << result.name;
  }
}

TEST(PlantedFaults, NoAnswersAreOneFinding) {
  const auto silent = [](const Recording& run) {
    return std::vector<double>(run.time.size(), std::nan(""));
  };
  EXPECT_EQ(failed(silent), Names{"finite"});
}

Provenance provenance_of(const SimulatedRun& run) {
  Provenance provenance;
  provenance.training = {{"train.h5", std::string(64, '0'),
                          measured_sha256(run.recording),
                          measured_sketch(run.recording)}};
  return provenance;
}

TEST(PlantedFaults, TrainedOnTheTestRun) {
  const FunctionCompensator compensator(sound);
  const Provenance cheat = provenance_of(simulated_runs()[0]);
  CheckedCompensator all = checked(compensator);
  all.provenance = &cheat;
  EXPECT_EQ(failed_checks(all), Names{"hold_out"});

  const Recording sweep = training_sweep(0).recording;
  const Provenance honest = provenance_of({"sweep", RunPurpose::kSoak, sweep});
  all.provenance = &honest;
  EXPECT_EQ(failed_checks(all), Names{});
  EXPECT_TRUE(run_checks(all)[6].passed()) << run_checks(all)[6].words;
}

TEST(PlantedFaults, TheNoiseOfTheTrainingIsNoFaultButIsSaid) {
  const FunctionCompensator compensator(sound);
  CheckedCompensator all = checked(compensator);
  Recording run = *all.runs[0].recording;
  run.fidelity = "quasistatic";
  run.title = "title";
  run.seed = 7;
  all.runs[0].recording = &run;
  Provenance provenance;
  provenance.training = {{"train.h5", std::string(64, '0'), "", {}, 7}};
  all.provenance = &provenance;
  const CheckResult said = run_checks(all)[6];
  EXPECT_TRUE(said.passed());
  const std::string none =
      fmt::format("Training saw none of the {} runs", all.runs.size());
  EXPECT_EQ(said.words,
            none + ", but " + all.runs[0].name +
                " shares its seed of noise with the training run train.h5: "
                "turn-on offset and noise are the same.");
  all.runs[0].device = "5";  // of a set, whose devices have noise of their own
  EXPECT_EQ(run_checks(all)[6].words, none + ".");
}

TEST(PlantedFaults, TrainedOnADeviceOfTheTestSet) {
  const FunctionCompensator compensator(sound);
  const TrainingSet set{.name = "set",
                        .manifest_sha256 = std::string(64, 'a'),
                        .devices = 10,
                        .files = 1};
  TrainingSet part = set;
  part.device_numbers = {3, 4};
  Provenance provenance;
  provenance.training_set = part;
  CheckedCompensator all = checked(compensator);
  all.provenance = &provenance;
  all.set = &set;
  for (CheckedRun& run : all.runs) run.device = "5";
  EXPECT_EQ(failed_checks(all), Names{});
  all.runs[1].device = "4";
  EXPECT_EQ(failed_checks(all), Names{"hold_out"});
}

TEST(PlantedFaults, HeldOutRunsThatWereFittedLeak) {
  const FunctionCompensator compensator(sound);
  const SimulatedRun sweep{"sweep", RunPurpose::kSoak,
                           training_sweep(0).recording};
  Provenance provenance = provenance_of(sweep);
  provenance.held_out = provenance.training;
  CheckedCompensator all = checked(compensator);
  all.provenance = &provenance;
  EXPECT_EQ(failed_checks(all), Names{"causality"});
}

// The truth, and all of a rate that is added to the recording. What is no run,
// as a sweep over temperature, is answered as it is.
std::vector<double> perfect(const Recording& run) {
  const auto& temperature = column_values(run, "temperature");
  const auto is_of_run = [&](const SimulatedRun& known) {
    const auto& T = column_values(known.recording, "temperature");
    return temperature.size() >= 1000 &&
           std::equal(T.begin(), T.begin() + 1000, temperature.begin());
  };
  const auto known = std::ranges::find_if(simulated_runs(), is_of_run);
  if (known == simulated_runs().end()) return column_values(run, "rate");
  const auto& truth = column_values(known->recording, "true_rate");
  const auto& recorded = column_values(known->recording, "rate");
  std::vector<double> answers = column_values(run, "rate");
  for (std::size_t k = 0; k < answers.size(); ++k)
    answers[k] += truth[k] - recorded[k];
  return answers;
}

// It leaves no noise, as a filter would not either.
TEST(PlantedFaults, APerfectCompensatorFailsNothing) {
  const FunctionCompensator compensator(perfect);
  for (const CheckResult& result : run_checks(checked(compensator)))
    EXPECT_TRUE(result.passed() || may_be_untested(result) ||
                result.name == "allan_fingerprint")
        << result.name << ": " << result.words;
}

std::vector<double> identity(const Recording& run) {
  return column_values(run, "rate");
}

// The random rates of the shipped qualification. With these seeds some samples
// keep still for a second by chance, before the output filter has followed:
// slopes of -0.03 to 1.02 at single temperatures.
TEST(PlantedFaults, RandomRatesShowNoScaleFactor) {
  for (const std::uint64_t seed : {2104U, 101013U, 112013U}) {
    ScenarioPlan scenario = scenario_from(
        "[rate]\nrandom = { rms_deg_per_s = 30, bandwidth_Hz = 0.5 }\n",
        "[ambient]\npoints = [[0, 8], [3600, 8], [5400, 23]]\n", "5400", "10");
    scenario.seed = seed;
    const Recording run = simulated(scenario, nominal_device());
    EXPECT_TRUE(held_slopes(run).empty()) << seed;
  }
}

TEST(PlantedFaults, HeldRatesShowTheScaleFactorWithinItsUncertainty) {
  std::size_t held = 0;
  for (const SimulatedRun& run : simulated_runs())
    for (const auto& [slope, uncertainty] : held_slopes(run.recording)) {
      EXPECT_EQ(run.purpose, RunPurpose::kRateTable);
      EXPECT_LT(uncertainty, kMostSlopeUncertainty);
      EXPECT_NEAR(slope.raw / slope.truth, 1.0, 0.03);
      ++held;
    }
  EXPECT_GE(held, 5U);
}

// A gyro whose output filter weakens and delays fast rates and whose scale
// factor is off, beside a drift and noise.
Recording fast_random_rates(std::uint32_t seed) {
  RandomStream random(seed, 4, 0, RandomPurpose{0});
  RecordedRun signals;
  signals.duration = 120;
  signals.step = 0.01;
  Recording run = signals.recording();
  std::vector<double> rate, truth;
  double filtered = 0.0, smooth = 0.0;
  for (const double t : run.time) {
    smooth += 0.5 * (2.0 * random.normal() - smooth);  // to about 10 Hz
    filtered += 0.3 * (smooth - filtered);
    truth.push_back(smooth);
    rate.push_back(1.01 * filtered + 0.2 + 1e-3 * t + 0.1 * random.normal());
  }
  for (Column& column : run.columns) {
    if (column.name == "rate") column.values = rate;
    if (column.name == "true_rate") column.values = truth;
  }
  return run;
}

TEST(PlantedFaults, APerfectCompensatorIsNeverSaidToFollowFastRates) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const Recording run = fast_random_rates(seed);
    const auto correlation = [&](double share) {
      CheckedRun checked_run{.name = "random",
                             .purpose = RunPurpose::kRandomRate,
                             .recording = &run};
      for (const double truth : column_values(run, "true_rate"))
        checked_run.answer.rate.push_back(share * truth);
      const FunctionCompensator compensator(identity);
      CheckedCompensator all;
      all.compensator = &compensator;
      all.runs.push_back(checked_run);
      return check_rate_correlation(CheckContext(all, 1));
    };
    const CheckResult perfect_result = correlation(1.0);
    EXPECT_TRUE(perfect_result.passed())
        << seed << ": " << perfect_result.words;
    EXPECT_EQ(correlation(0.5).outcome, CheckOutcome::kFailed) << seed;
  }
}

// Faults of the bias leave the rate alone: no check fails, a metric does.

std::vector<double> twice(const Recording& run) {
  std::vector<double> answers = sound(run);
  const std::vector<double>& rate = column_values(run, "rate");
  for (std::size_t k = 0; k < answers.size(); ++k)
    answers[k] -= rate[k] - answers[k];
  return answers;
}

std::vector<double> in_reverse_order(const Recording& run) {
  FittedCompensator compensator = trained("cubic");
  auto& polynomial = std::get<Polynomial>(compensator.bias.function);
  std::ranges::reverse(polynomial.coefficients);
  return compensated_rate(compensator, run);
}

std::vector<double> with_the_wrong_sign(const Recording& run) {
  return sound(with_temperature(run, [](double T) { return -T; }));
}

std::vector<double> off_by_10_kelvin(const Recording& run) {
  return sound(with_temperature(run, [](double T) { return T - 10.0; }));
}

// The decision on a residual of at most 15 % of the recorded one. The ramps of
// the runs, 5 K/min, leave 10 % to the sound compensator.
Verdict residual_decision(const Function& function) {
  const Limit limit{.metric = "residual_rms_deg_per_s",
                    .most = 0.15,
                    .relative_to = "before"};
  const Metric& residual = *find_metric(limit.metric);
  const FunctionCompensator compensator(function);
  return decide(limit, residual.evaluate(evidence_of(checked(compensator))),
                residual.evaluate(recorded_evidence()))
      .result;
}

TEST(PlantedFaults, FaultsOfTheBiasAreCaughtByTheResidual) {
  EXPECT_EQ(residual_decision(sound), Verdict::kPass);
  for (const Function& fault :
       {Function(twice), Function(in_reverse_order),
        Function(with_the_wrong_sign), Function(off_by_10_kelvin)}) {
    EXPECT_EQ(residual_decision(fault), Verdict::kFail);
    EXPECT_EQ(failed(fault), Names{});
  }
}

TEST(PlantedFaults, IdentityPassesTheChecksAndLeavesTheDrift) {
  EXPECT_EQ(failed(identity), Names{});
  const Metric& residual = *find_metric("residual_rms_deg_per_s");
  const FunctionCompensator compensator(identity);
  const auto after = residual.evaluate(evidence_of(checked(compensator)));
  const auto before = residual.evaluate(recorded_evidence());
  EXPECT_EQ(after->value, before->value);
  EXPECT_EQ(residual_decision(identity), Verdict::kFail);
}

TEST(PlantedFaults, APerfectCompensatorMeetsEveryShippedLimit) {
  const FunctionCompensator compensator(perfect);
  const Evidence after = evidence_of(checked(compensator));
  const Evidence before = recorded_evidence();
  for (const char* name : {"paper", "share", "uav", "tactical"})
    for (const Limit& limit :
         read_specification_file(BEAMGYRO_SPECS "/" + std::string(name) +
                                 ".toml")
             .limits) {
      const Metric& metric = *find_metric(limit.metric);
      const auto found = metric.evaluate(after);
      const Decision decision = decide(limit, found, metric.evaluate(before));
      EXPECT_NE(decision.result, Verdict::kFail) << decision.words;
      if (limit.metric.starts_with("residual")) {
        EXPECT_LT(std::abs(found->value), 1e-12) << limit.metric;
        EXPECT_EQ(decision.result, Verdict::kPass) << decision.words;
      }
    }
}

}  // namespace
}  // namespace beamgyro::internal::planted_faults_test
