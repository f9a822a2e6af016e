// SPDX-License-Identifier: MIT
#include "compensation/training/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compensation/training/cautions.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/rows_of.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::selection_test {
namespace {

const std::vector<Input> kTemperature = {parse_input("temperature")};
const std::vector<Input> kWithPowerOn = {parse_input("temperature"),
                                         parse_input("since_power_on(700)")};

Candidate candidate(const std::string& name, const FitSpec& kind) {
  return {name, kTemperature, kind};
}

BpSpec network(const std::vector<double>& decays = {0.0}) {
  BpSpec spec;
  spec.hidden = {3};
  spec.weight_decays = decays;
  spec.training.max_epochs = 40;
  return spec;
}

const Candidate kNone = candidate("none", NoneSpec{});
const Candidate kConstant = candidate("constant", ConstantSpec{});
const Candidate kLinear = candidate("linear", PolynomialSpec{1});
const Candidate kCubic = candidate("cubic", PolynomialSpec{3});
const Candidate kSpline = candidate("spline", SplineSpec{});
const Candidate kNetwork = candidate("bp(3)", network());

const Leg kUp{0, 0, -40.0, 50.0, 91}, kDown{0, 0, 50.0, -40.0, 91};

Selected select(const std::vector<Candidate>& candidates,
                const TrainingRows& rows,
                const std::optional<RowGroups>& groups = {},
                const TrainingRows& held_out = {},
                const std::vector<Input>& inputs = kTemperature) {
  return select_model(candidates, {inputs, rows, held_out, groups, 1});
}

Selected select_by_folds(const std::vector<Candidate>& candidates,
                         const TrainingRows& rows) {
  return select(candidates, rows, folds_of(rows, 3));
}

// The line of the report that starts with `name`.
std::string explanation(const Selected& selected, const std::string& name) {
  const auto& lines = selected.fit.choices;
  const auto line = std::find_if(
      lines.begin(), lines.end(),
      [&](const std::string& text) { return text.starts_with(name); });
  return line == lines.end() ? "nothing" : *line;
}

double curved(double T, int /*row*/) { return bias_curve(T); }

std::vector<Leg> runs_up(int count) {
  std::vector<Leg> legs;
  for (int k = 0; k < count; ++k) legs.push_back({k, k, -40.0, 50.0, 46});
  return legs;
}

TEST(Selection, OneLegTakesCurvesUpToTheCubicAndSaysWhy) {
  const Selected selected =
      select_by_folds({kNone, kConstant, kLinear, kCubic, kSpline, kNetwork},
                      rows_of({kUp}, curved));
  EXPECT_EQ(selected.candidate.name, "cubic");
  for (const std::string name : {"spline", "bp(3)"})
    EXPECT_TRUE(holds(explanation(selected, name),
                      "passed over, the recordings are "
                      "one leg of temperature"));
  EXPECT_TRUE(holds(explanation(selected, "cubic"), "over 5 unseen segments"));
  EXPECT_TRUE(explanation(selected, "kept cubic").starts_with("kept cubic"));
}

TEST(Selection, OneLegIsAConstantWhenOnlyNoiseMoves) {
  const std::vector<double> noise = white(91, 3);
  const Selected selected = select_by_folds(
      {kConstant, kLinear, kCubic}, rows_of({kUp}, [&](double, int k) {
        return 1.0 + 0.01 * noise[static_cast<std::size_t>(k)];
      }));
  EXPECT_EQ(selected.candidate.name, "constant");
  EXPECT_TRUE(holds(explanation(selected, "cubic"), "no more than slow noise"));
}

// A straight line is in the cubic too; segments excuse no simplicity.
TEST(Selection, OneLegKeepsTheRichestCurve) {
  const auto line = [](double T, int k) { return T + (k % 2 == 0 ? 1 : -1); };
  EXPECT_EQ(select_by_folds({kConstant, kLinear, kCubic}, rows_of({kUp}, line))
                .candidate.name,
            "cubic");
  EXPECT_EQ(select_by_folds({kConstant, kLinear}, rows_of({kUp}, line))
                .candidate.name,
            "linear");
}

// Two temperatures: a cubic is passed over, a line is not.
TEST(Selection, PassesOverWhatTheRowsDoNotDetermine) {
  const TrainingRows rows = rows_of(
      {{0, 0, 20.0, 21.5, 46}, {1, 1, 20.0, 21.5, 46}, {2, 2, 20.0, 21.5, 46}},
      [](double T, int) { return T; });
  const Selected selected = select_by_folds({kConstant, kLinear, kCubic}, rows);
  EXPECT_EQ(selected.candidate.name, "linear");
  EXPECT_TRUE(holds(explanation(selected, "cubic"),
                    "passed over, without run 1: temperature"));
}

// Slopes of three legs, T from -1 to 1: what two of them leave of the third,
// over the better of a constant and the cubic, which are fitted to both.
double left_of_the_third(double up, double down, double third,
                         double& constant) {
  const auto slope = [&](double T, int k) {
    return (k < kUp.rows ? up : down) * (T - 5.0) / 45.0;
  };
  const TrainingRows rows = rows_of({kUp, kDown}, slope);
  const Selected selected =
      select_by_folds({kNone, kConstant, kLinear, kCubic, kSpline}, rows);
  const TrainingRows unseen =
      rows_of({kUp}, [&](double T, int) { return third * (T - 5.0) / 45.0; });
  constant =
      rms_residual({{Scale{}}, {}, ConstantBias{rows.bias.mean()}}, unseen);
  return rms_residual(selected.fit.model, unseen);
}

// Of two legs of slopes 1 and s no line is safe against every third. A line of
// slope w m, m = (1 + s)/2, leaves more than 1.6 times the better of constant
// and cubic (of slopes 0 and m) where the third has a slope
//   from -w m/0.6 to w m/2.6, or from (1.6 + w) m/2.6 to (1.6 - w) m/0.6:
// 2.05 m in all, whatever w is. Lines that are safe at the third's slopes s/2
// to s exist for every s: those have to hold.
TEST(Selection, LegsThatDisagreeCostNoMoreThanTheBetterOfConstantAndCubic) {
  for (int n = 0; n <= 20; ++n) {
    const double s = 0.05 * n, m = 0.5 * (1.0 + s);
    for (const double third : {0.5 * s, 0.75 * s, s}) {
      double constant = 0.0;
      const double left = left_of_the_third(1.0, s, third, constant);
      const double unit = third > 0.0 ? constant / third : 0.0;
      const double best = std::min(third, std::abs(third - m)) * unit;
      EXPECT_LE(left, 1.6 * best + 1e-9) << "slopes 1, " << s << ", " << third;
    }
  }
}

// Two legs leave room below the weight of the least error, 2 s/(1 + s^2): it is
// a quarter of its standard error, 2 s (1 - s^2)/(1 + s^2)^2, lower.
TEST(Selection, AveragesWithAConstantByWhatLegsAgreeOn) {
  const TrainingRows rows = rows_of({kUp, kDown}, [](double T, int k) {
    return (k < kUp.rows ? 1.0 : 0.3) * (T - 5.0) / 45.0;
  });
  const Selected selected = select_by_folds({kConstant, kLinear}, rows);
  EXPECT_NEAR(selected.weight, 0.6 / 1.09 - 0.25 * 0.6 * 0.91 / (1.09 * 1.09),
              1e-9);
  const Eigen::ArrayXd ends =
      selected.fit.model.predict(Eigen::ArrayXd{{-40.0, 50.0}});
  EXPECT_NEAR(ends(1) - ends(0), 2.0 * 0.65 * selected.weight, 1e-9);
  EXPECT_NEAR(ends.mean(), 0.0, 1e-9);
  EXPECT_TRUE(holds(explanation(selected, "linear"),
                    "so 0.44 of it and 0.56 of a constant are used"));
  EXPECT_FALSE(
      objection_to_claim(selected.errors, selected.constant_errors).empty());
}

// Slopes of 1 and -1: the weight of the least error is 0.
TEST(Selection, ACurveOfWeightZeroIsAConstant) {
  const TrainingRows rows = rows_of({kUp, kDown}, [](double T, int k) {
    return (k < kUp.rows ? 1.0 : -1.0) * (T - 5.0) / 45.0;
  });
  const Selected selected = select_by_folds({kLinear, kCubic}, rows);
  EXPECT_TRUE(is_constant(selected.candidate.kind));
  EXPECT_EQ(selected.weight, 1.0);
  EXPECT_FALSE(reads_inputs(selected.fit.model));
  EXPECT_NEAR(selected.fit.model.predict(Eigen::ArrayXd{{30.0}})(0), 0.0,
              1e-12);
}

// The weight decays of one network are no automatic choice.
TEST(Selection, OneNetworkIsNotAveragedThoughTheLegsDisagree) {
  const TrainingRows rows = rows_of({kUp, kDown}, [](double T, int k) {
    return (k < kUp.rows ? 1.0 : -1.0) * (T - 5.0) / 45.0;
  });
  const Selected selected =
      select_by_folds({candidate("bp(3)", network({0.0, 1e-6}))}, rows);
  EXPECT_TRUE(std::holds_alternative<BpSpec>(selected.candidate.kind));
  EXPECT_EQ(selected.weight, 1.0);
  EXPECT_TRUE(reads_inputs(selected.fit.model));
  EXPECT_FALSE(
      objection_to_claim(selected.errors, selected.constant_errors).empty());
}

TEST(Selection, ThreeLegsThatDisagreeClaimNothingThoughTheAverageGains) {
  const TrainingRows rows = rows_of({kUp, kDown, kUp}, [](double T, int k) {
    return (k < 2 * kUp.rows ? 1.0 : 0.2) * (T - 5.0) / 45.0;
  });
  const Selected selected = select_by_folds({kConstant, kLinear}, rows);
  ASSERT_LT(selected.weight, 1.0);
  EXPECT_EQ(selected.errors->size(), 3);
  EXPECT_EQ(objection_to_claim(selected.errors, selected.constant_errors), "");
  EXPECT_TRUE(
      holds(objection_to_claim(selected.errors, selected.constant_errors,
                               selected.weight),
            "the groups disagree"));
}

TEST(Selection, LegsThatAgreeKeepTheWholeCurve) {
  const std::vector<double> noise = white(182, 5);
  const Selected selected = select_by_folds(
      {kConstant, kCubic}, rows_of({kUp, kDown}, [&](double T, int k) {
        return bias_curve(T) + 0.05 * noise[static_cast<std::size_t>(k)];
      }));
  EXPECT_EQ(selected.weight, 1.0);
  EXPECT_EQ(selected.candidate.name, "cubic");
}

// A line under a bias that alternates by +-1 from row to row, which itself has
// a slope of 0.065 over 46 rows: the rms falls by 8 % and by 15 %.
TEST(Selection, AGainThatIsOfNoUseKeepsTheConstant) {
  const auto choice = [](double slope) {
    return select_by_folds(
        {kConstant, kLinear}, rows_of(runs_up(3), [&](double T, int k) {
          return slope * (T - 5.0) / 45.0 + (k % 2 == 0 ? -1.0 : 1.0);
        }));
  };
  const Selected small = choice(0.65);
  EXPECT_EQ(small.candidate.name, "constant");
  EXPECT_TRUE(holds(explanation(small, "kept"), "less than 10 %"));
  EXPECT_EQ(choice(1.0).candidate.name, "linear");
}

// A ripple that a cubic leaves and a spline does not, under row noise: the
// spline takes some 4 % of the cubic's rms away, then nine tenths.
TEST(Selection, TheCubicIsKeptUnlessAnotherIsClearlyBetter) {
  const std::vector<double> noise = white(182, 7);
  const auto choice = [&](double share) {
    return select_by_folds({kConstant, kLinear, kCubic, kSpline},
                           rows_of({kUp, kDown}, [&](double T, int k) {
                             return 0.03 * T + share * std::sin(0.35 * T) +
                                    0.05 * noise[static_cast<std::size_t>(k)];
                           }));
  };
  const Selected little = choice(0.0195);
  EXPECT_EQ(little.candidate.name, "cubic")
      << explanation(little, "cubic") << explanation(little, "spline");
  EXPECT_TRUE(holds(explanation(little, "kept cubic"), "spline takes"));
  EXPECT_EQ(choice(1.0).candidate.name, "spline");
}

// A step of 1 deg/s on a line, at which a spline rings. Under row noise of 0.1
// and of 0.05 the table leaves 6 and 12 % less than the spline.
TEST(Selection, ATableIsKeptOnlyWhereItLeavesATenthLessThanASpline) {
  const std::vector<double> noise = white(182, 9);
  const auto choice = [&](double sigma) {
    return select_by_folds(
               {kConstant, kCubic, kSpline, candidate("table", TableSpec{})},
               rows_of({kUp, kDown},
                       [&](double T, int k) {
                         return (T < 5.0 ? -0.5 : 0.5) + 0.05 * T +
                                sigma * noise[static_cast<std::size_t>(k)];
                       }))
        .candidate.name;
  };
  EXPECT_EQ(choice(0.1), "spline");
  EXPECT_EQ(choice(0.05), "table");
}

// A line, and the same line with a bend b of the other leg's own: a cubic of
// one leg leaves the bend, rms 0.298, of the other. A constant leaves 0.115 and
// 0.320, together 19 % less, but more of the second leg.
TEST(Selection, AConstantThatIsBetterInOneLegOnlyIsNoEvidence) {
  const TrainingRows rows = rows_of({kUp, kDown}, [](double T, int k) {
    const double x = (T - 5.0) / 45.0;
    return 0.2 * x + (k < kUp.rows ? 0.0 : x * x - 1.0 / 3.0);
  });
  const Selected selected =
      select_by_folds({kNone, kConstant, kLinear, kCubic}, rows);
  EXPECT_EQ(selected.candidate.name, "cubic");
  EXPECT_EQ(selected.weight, 1.0);
}

// Of legs 0.3 x +- h (x^2 - 1) a cubic of the other one leaves 1.46 h, nothing
// at all leaves sqrt(0.03 + 0.53 h^2): 6 % less with h = 0.15 and 45 % less
// with h = 0.4. The loop between the legs is no scale of a curve.
TEST(Selection, LegsThatDifferInShapeKeepTheWholeCubic) {
  const auto choice = [](double h) {
    return select_by_folds({kNone, kConstant, kLinear, kCubic},
                           rows_of({kUp, kDown}, [&](double T, int k) {
                             const double x = (T - 5.0) / 45.0;
                             return 0.3 * x +
                                    (k < kUp.rows ? h : -h) * (x * x - 1.0);
                           }));
  };
  const Selected selected = choice(0.15);
  EXPECT_EQ(selected.candidate.name, "cubic");
  EXPECT_EQ(selected.weight, 1.0);
  EXPECT_TRUE(holds(explanation(selected, "kept cubic"),
                    "evidence is 10 % and more than the standard error over 2 "
                    "legs"));
  EXPECT_TRUE(is_constant(choice(0.4).candidate.kind));
}

TEST(Selection, TwoLegsAreTooFewForANetwork) {
  const Selected selected = select_by_folds(
      {kConstant, kCubic, kSpline, kNetwork}, rows_of({kUp, kDown}, curved));
  EXPECT_EQ(selected.candidate.name, "spline");
  EXPECT_TRUE(holds(explanation(selected, "bp(3)"),
                    "passed over, 3 legs or more judge a network"));
}

TEST(Selection, ThreeRunsAreEnoughForANetwork) {
  const Selected selected = select_by_folds({kConstant, kLinear, kNetwork},
                                            rows_of(runs_up(3), curved));
  EXPECT_EQ(selected.candidate.name, "bp(3)");
  EXPECT_TRUE(
      holds(explanation(selected, "kept"), "kept bp(3): the lowest residual"));
  EXPECT_LT(rms_of(*selected.errors), 0.2 * rms_of(*selected.constant_errors));
}

TEST(Selection, EveryWeightDecayIsACandidateTheStrongestFirst) {
  const Selected selected = select_by_folds(
      {kConstant, candidate("bp(3)", network({0.0, 1e-2, 1e-4}))},
      rows_of(runs_up(3), curved));
  std::vector<std::string> networks;
  for (const std::string& line : selected.fit.choices)
    if (line.starts_with("bp(3)"))
      networks.push_back(line.substr(0, line.find(':')));
  EXPECT_EQ(networks, (std::vector<std::string>{"bp(3), weight decay 0.01",
                                                "bp(3), weight decay 0.0001",
                                                "bp(3), weight decay 0"}));
}

// Time since power-on as a second input, which a network would use.
TEST(Selection, ANetworkOfSeveralInputsNeedsThreeGroups) {
  TrainingRows rows = rows_of({kUp, kDown}, curved);
  rows.inputs.conservativeResize(Eigen::NoChange, 2);
  rows.inputs.col(1) = rows.time;
  const Candidate several{"BP network 3", kWithPowerOn, network()};
  const std::string message = rejection([&] {
    select({several}, rows, group_rows(rows, Grouping::kLeg), {}, kWithPowerOn);
  });
  EXPECT_TRUE(holds(message,
                    "3 legs or more judge a network of several inputs, here "
                    "temperature, since_power_on(700); the recordings have 2"));
  // Of one input two are enough.
  EXPECT_TRUE(select_by_folds({kNetwork}, rows_of({kUp, kDown}, curved))
                  .errors.has_value());
}

TEST(Selection, TimeSincePowerOnNeedsPowerOnsAtSeveralTemperatures) {
  const auto choice = [](const std::vector<double>& starts) {
    std::vector<Leg> legs;
    for (std::size_t k = 0; k < starts.size(); ++k)
      legs.push_back({int(k), int(k), starts[k], starts[k] + 60.0, 61});
    TrainingRows rows =
        rows_of(legs, [](double T, int k) { return 0.1 * T + k % 61 * 0.01; });
    rows.inputs.conservativeResize(Eigen::NoChange, 2);
    for (Eigen::Index k = 0; k < rows.size(); ++k)
      rows.inputs(k, 1) = std::exp(-60.0 * double(k % 61) / 700.0);
    return select(
        {kConstant, kLinear, {"slopes", kWithPowerOn, PolynomialSpec{1}}}, rows,
        group_rows(rows, Grouping::kRun), {}, kWithPowerOn);
  };
  const Selected same = choice({-40.0, -39.0, -35.0});
  EXPECT_EQ(same.candidate.name, "linear");
  EXPECT_TRUE(holds(explanation(same, "slopes"),
                    "power-ons at 3 temperatures 10 K apart; the recordings "
                    "have 1"));
  const Selected several = choice({-40.0, -30.0, -20.0});
  EXPECT_EQ(several.candidate.name, "slopes");
}

TEST(Selection, WithoutGroupsHeldOutRowsJudge) {
  const TrainingRows rows = rows_of({kUp}, curved);
  const TrainingRows held_out = rows_of({kDown}, curved);
  const Selected selected =
      select({kConstant, kLinear, kSpline}, rows, {}, held_out);
  EXPECT_EQ(selected.candidate.name, "spline");
  EXPECT_TRUE(holds(explanation(selected, "spline"), "unseen segments"));
  // Equal groups or not, the means are over about the same rows.
  EXPECT_NEAR(rms_of(*selected.errors),
              rms_residual(selected.fit.model, held_out),
              0.1 * rms_of(*selected.errors));
  EXPECT_GT(rms_of(*selected.constant_errors), 0.5);
}

TEST(Selection, OfOneCandidateTellsItsErrorsOnUnseenGroups) {
  const TrainingRows rows = rows_of(runs_up(3), curved);
  const RowGroups groups = group_rows(rows, Grouping::kRun);
  const Selected selected = select({kCubic}, rows, groups);
  const GroupErrors errors = group_errors(
      predict_unseen(PolynomialSpec{3}, kTemperature, rows, groups, 1),
      rows.bias, groups);
  EXPECT_TRUE((*selected.errors == errors).all());
  EXPECT_FALSE(select({kCubic}, rows).errors.has_value());
}

TEST(Selection, RefusesWhenNoCandidateIsLeft) {
  const std::string one_leg = rejection([] {
    select_by_folds({kSpline, kNetwork}, rows_of({kUp}, curved));
  });
  EXPECT_TRUE(
      holds(one_leg, "no candidate can be judged: spline: passed over"));
  const std::string narrow = rejection([] {
    std::vector<Leg> legs = runs_up(3);
    for (Leg& leg : legs) leg.from = leg.to = 20.0;
    const TrainingRows rows = rows_of(legs, curved);
    select({kLinear, kCubic}, rows, group_rows(rows, Grouping::kRun));
  });
  EXPECT_TRUE(holds(narrow, "no candidate can be fitted: linear: passed over"));
}

}  // namespace
}  // namespace beamgyro::internal::selection_test
