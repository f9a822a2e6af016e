// SPDX-License-Identifier: MIT
#include "compensation/training/train.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compensation/compensator/compensator_file.h"
#include "compensation/export/export_c.h"
#include "compensation/export/export_parameters.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::train_test {
namespace {

// Soaks of 2 min every `step` K, without ramps between them.
Recording soaks(double low, double high, double step) {
  const Eigen::ArrayXd T = grid(low, high, step);
  RecordedRun run{.duration = 120.0 * double(T.size()), .step = 1.0};
  run.temperature = [=](double t) {
    return T(static_cast<Eigen::Index>(t / 120.0));
  };
  run.bias = [=](double t) { return bias_curve(run.temperature(t)); };
  return run.recording();
}

// A gyro whose beam follows the sensor with a lag of 200 s.
Recording ramp(double rate, double duration) {
  RecordedRun run{.duration = duration, .step = 1.0};
  run.temperature = [=](double t) { return -40.0 + rate * t; };
  run.bias = [=](double t) {
    return bias_curve(-40.0 +
                      rate * (t - 200.0 * (1.0 - std::exp(-t / 200.0))));
  };
  return run.recording();
}

std::vector<TrainingRun> runs(const std::vector<Recording>& recordings,
                              const std::string& name) {
  std::vector<TrainingRun> result;
  for (const Recording& recording : recordings) {
    const std::string number = name + std::to_string(result.size());
    result.push_back({number + ".h5", "sha of " + number, recording});
  }
  return result;
}

ModelSpec network_spec(const std::vector<std::string>& inputs, int hidden) {
  ModelSpec spec;
  for (const std::string& input : inputs)
    spec.inputs.push_back(parse_input(input));
  BpSpec bp;
  bp.hidden = {hidden};
  spec.kind = bp;
  return spec;
}

ModelSpec curve_spec(const decltype(ModelSpec::kind)& kind) {
  return {.inputs = {parse_input("temperature")}, .kind = kind};
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

const std::vector<TrainingRun> kSoaks =
    runs({soaks(-40.0, 50.0, 5.0)}, "soaks");
const std::vector<TrainingRun> kOffGrid =
    runs({soaks(-37.5, 47.5, 5.0)}, "off_grid");

TEST(Train, TheDriveFrequencyOfADeviceThatAgesIsWarnedOf) {
  Recording run = soaks(-40.0, 50.0, 5.0);
  Column frequency{"drive_frequency", "Hz", "", Role::kMeasured, {}};
  for (const double T : column_values(run, "temperature"))
    frequency.values.push_back(9000.0 - 0.1 * T + 1e-3 * T * T);
  run.columns.insert(run.columns.begin(), frequency);
  ModelSpec spec = curve_spec(PolynomialSpec{3});
  spec.inputs.push_back(parse_input("drive_frequency"));
  const auto warned = [&] {
    return std::ranges::count_if(train(spec, runs({run}, "soaks"), {}, 1)
                                     .compensator.provenance.warnings,
                                 [](const std::string& warning) {
                                   return warning.find("no thermometer") !=
                                          std::string::npos;
                                 });
  };
  EXPECT_EQ(warned(), 0);
  run.device_text = "[memory.ageing]\n";
  EXPECT_EQ(warned(), 1);
}

TEST(Train, EveryKindBeatsItsBaselineOnUnseenSoaks) {
  const Recording unseen = soaks(-38.0, 48.0, 2.0);
  for (const ModelSpec& spec :
       {curve_spec(SplineSpec{}), curve_spec(PolynomialSpec{9}),
        network_spec({"temperature"}, 6)}) {
    const FittedCompensator c = train(spec, kSoaks, kOffGrid, 1).compensator;
    EXPECT_LT(rms(compensated_rate(c, unseen)),
              0.15 * rms(baseline_rate(c, unseen)))
        << kind_name(c.bias);
  }
}

TEST(Train, CubicIsItsOwnBaseline) {
  const TrainResult result =
      train(curve_spec(PolynomialSpec{3}), kSoaks, {}, 1);
  EXPECT_EQ(result.summary().stop_reason, StopReason::kLeastSquares);
  EXPECT_FALSE(result.summary().held_out_rms.has_value());
  const Recording unseen = soaks(-38.0, 48.0, 2.0);
  EXPECT_EQ(compensated_rate(result.compensator, unseen),
            baseline_rate(result.compensator, unseen));
  EXPECT_NEAR(result.summary().in_sample_rms, 0.39, 0.06);
}

TEST(Train, StraightLinesAreABaselineWhereThereAreSoaks) {
  // Of 10 min, 15 K apart.
  RecordedRun run{.duration = 600.0 * 7, .step = 1.0};
  run.temperature = [](double t) { return -40.0 + 15.0 * std::floor(t / 600); };
  run.bias = [T = run.temperature](double t) { return bias_curve(T(t)); };
  const Recording unseen = soaks(-38.0, 48.0, 2.0);
  const FittedCompensator c =
      train(curve_spec(SplineSpec{15.0}), runs({run.recording()}, "few"),
            runs({unseen}, "unseen"), 1)
          .compensator;
  ASSERT_TRUE(c.straight_lines.has_value());
  EXPECT_EQ(c.straight_lines->temperatures.size(), 7);
  EXPECT_LT(*c.provenance.lines_in_sample_rms, 1e-9);
  EXPECT_NEAR(*c.provenance.lines_held_out_rms,
              rms(straight_lines_rate(c, unseen)), 1e-9);
  const FittedCompensator back =
      parse_compensator(compensator_text(c), "few.json");
  EXPECT_EQ(straight_lines_rate(back, unseen), straight_lines_rate(c, unseen));
  EXPECT_EQ(back.provenance, c.provenance);
  // Soaks of 2 min are none.
  const FittedCompensator short_ones =
      train(curve_spec(SplineSpec{}), kSoaks, {}, 1).compensator;
  EXPECT_FALSE(short_ones.straight_lines.has_value());
  EXPECT_FALSE(short_ones.provenance.lines_in_sample_rms.has_value());
}

TEST(Train, SummaryAndProvenanceSayWhatHappened) {
  const TrainResult result =
      train(network_spec({"temperature"}, 6), kSoaks, kOffGrid, 42);
  const Provenance& p = result.compensator.provenance;
  EXPECT_EQ(result.restarts.size(), 4u);
  EXPECT_EQ(result.rows, 2 * 19);
  EXPECT_EQ(result.held_out_rows, 2 * 18);
  EXPECT_EQ(p.seed, 42u);
  EXPECT_EQ(p.training[0].name, "soaks0.h5");
  EXPECT_EQ(p.training[0].sha256, "sha of soaks0");
  EXPECT_EQ(p.held_out[0].name, "off_grid0.h5");
  EXPECT_EQ(p.stop_reason, sentence(result.summary().stop_reason));
  // The held-out score is that of the compensator on the held-out run.
  EXPECT_NEAR(*p.held_out_rms,
              rms(compensated_rate(result.compensator, kOffGrid[0].recording)),
              1e-9);
  EXPECT_LT(*p.held_out_rms, 0.006);
  EXPECT_GT(*p.baseline_held_out_rms, 0.3);
}

TEST(Train, EveryRestartIsScoredInDegreesPerSecond) {
  const TrainResult result =
      train(network_spec({"temperature"}, 6), kSoaks, kOffGrid, 42);
  for (const TrainSummary& restart : result.restarts)
    EXPECT_GE(*restart.held_out_rms, *result.summary().held_out_rms);
}

TEST(Train, GoalIsInDegreesPerSecond) {
  ModelSpec spec = network_spec({"temperature"}, 6);
  BpSpec& bp = std::get<BpSpec>(spec.kind);
  // Slow enough that the error stops just below its goal.
  bp.training.trainer = Trainer::kGradientAdaptive;
  bp.training.max_epochs = bp.training.patience = 20000;
  bp.training.restarts = 1;
  for (const double goal : {0.2, 0.1, 0.05}) {  // [deg/s]
    bp.goal_deg_per_s = goal;
    const TrainSummary summary = train(spec, kSoaks, kOffGrid, 1).summary();
    EXPECT_EQ(summary.stop_reason, StopReason::kGoalReached);
    EXPECT_LE(summary.in_sample_rms, goal);
    EXPECT_GT(summary.in_sample_rms, 0.6 * goal);
  }
}

TEST(Train, SameSeedGivesTheSameFile) {
  const ModelSpec spec = network_spec({"temperature"}, 6);
  const auto text = [&](std::uint64_t seed) {
    return compensator_text(train(spec, kSoaks, kOffGrid, seed).compensator);
  };
  EXPECT_EQ(text(3), text(3));
  EXPECT_NE(text(3), text(4));
}

TEST(Train, FilteredTemperatureTakesTheLagOfTheBeamIntoAccount) {
  const std::vector<TrainingRun> training =
      runs({ramp(1.0 / 60.0, 5400.0), ramp(2.0 / 60.0, 2700.0),
            ramp(0.5 / 60.0, 10800.0)},
           "ramp");
  const std::vector<TrainingRun> held_out =
      runs({ramp(1.25 / 60.0, 4320.0)}, "held");
  const Recording unseen = ramp(1.5 / 60.0, 3600.0);
  const FittedCompensator lagged =
      train(network_spec({"temperature", "temperature_lowpass(200)"}, 8),
            training, held_out, 1)
          .compensator;
  const FittedCompensator plain =
      train(network_spec({"temperature"}, 8), training, held_out, 1)
          .compensator;
  EXPECT_LT(rms(compensated_rate(lagged, unseen)),
            0.1 * rms(compensated_rate(plain, unseen)));
}

// Two legs with slopes of 1 and 0.3: the line is averaged with a constant.
TEST(Train, AnAverageWithAConstantIsStoredAndExportedAsItsKind) {
  const auto leg = [](double from, double to, double slope) {
    RecordedRun run{.duration = 5400.0, .step = 1.0};
    run.temperature = [=](double t) { return from + (to - from) * t / 5400.0; };
    run.bias = [=](double t) { return slope * run.temperature(t); };
    return run.recording();
  };
  const std::vector<Input> inputs = {parse_input("temperature")};
  const ModelSpec spec{.inputs = inputs,
                       .candidates = {{"constant", inputs, ConstantSpec{}},
                                      {"linear", inputs, PolynomialSpec{1}}}};
  const FittedCompensator c =
      train(spec, runs({leg(-40.0, 40.0, 1.0), leg(40.0, -40.0, 0.3)}, "leg"),
            {}, 1)
          .compensator;
  EXPECT_EQ(c.provenance.method,
            "straight line of weight 0.44 beside a constant");
  EXPECT_EQ(c.provenance.cross_validated->group_rms.size(), 2U);
  // The weight of the least error less a quarter of its standard error.
  const double slope = 0.65 * (0.6 / 1.09 - 0.25 * 0.6 * 0.91 / (1.09 * 1.09));
  EXPECT_NEAR(coefficients_about(c.bias, 0.0)[1], slope, 1e-3);
  EXPECT_NEAR(coefficients_about(autopilot_cubic(c, false), 0.0)[1], slope,
              1e-3);
  EXPECT_TRUE(holds(export_c(c, "average").source, "coefficients"));
  const Recording unseen = leg(-40.0, 40.0, 0.5);
  const FittedCompensator again =
      parse_compensator(compensator_text(c), "c.json");
  EXPECT_EQ(again.provenance, c.provenance);
  EXPECT_EQ(compensated_rate(again, unseen), compensated_rate(c, unseen));
  ASSERT_FALSE(c.provenance.warnings.empty());
  EXPECT_TRUE(holds(c.provenance.warnings.back(), "no improvement to claim"));
}

TEST(Train, RefusesWhatCannotBeTrainedOn) {
  const ModelSpec network = network_spec({"temperature"}, 6);
  const auto message = [](const ModelSpec& spec, const auto& training,
                          const auto& held_out) {
    return rejection([&] { train(spec, training, held_out, 1); });
  };
  EXPECT_TRUE(holds(message(network, kSoaks, std::vector<TrainingRun>{}),
                    "pass held_out = RUN.h5"));
  EXPECT_TRUE(holds(message(network, std::vector<TrainingRun>{}, kOffGrid),
                    "at least one recording"));
  EXPECT_TRUE(holds(message(network, kSoaks, kSoaks), "must be another run"));
  const auto narrow = runs({soaks(20.0, 23.0, 1.5)}, "narrow");
  EXPECT_TRUE(holds(message(curve_spec(PolynomialSpec{3}), narrow, kOffGrid),
                    "between 20.00 and 23.00 degC"));
  const std::string missing =
      message(network_spec({"temperature", "quadrature"}, 6), kSoaks, kOffGrid);
  EXPECT_TRUE(holds(missing, "soaks0.h5: input \"quadrature\""));
  RecordedRun still{.duration = 600.0, .step = 1.0};
  still.temperature = [](double t) { return -40.0 + 0.1 * t; };
  EXPECT_TRUE(holds(message(network_spec({"output"}, 6),
                            runs({still.recording()}, "still"), kOffGrid),
                    "input output is 2.5 in all 10 training rows"));
}

}  // namespace
}  // namespace beamgyro::internal::train_test
