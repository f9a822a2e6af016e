// SPDX-License-Identifier: MIT
#include "compensation/training/cross_validation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compensation/methods/bias_model.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/rows_of.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::cross_validation_test {
namespace {

const std::vector<Input> kTemperature = {parse_input("temperature")};

GroupErrors errors_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(
      values.data(), static_cast<Eigen::Index>(values.size()));
}

// Runs from -40 to 50 degC, up and down by turns.
std::vector<Leg> sweeps(int runs, int rows) {
  std::vector<Leg> legs;
  for (int k = 0; k < runs; ++k)
    legs.push_back(k % 2 == 0 ? Leg{k, k, -40.0, 50.0, rows}
                              : Leg{k, k, 50.0, -40.0, rows});
  return legs;
}

BpSpec small_network() {
  BpSpec spec;
  spec.hidden = {3};
  spec.training.max_epochs = 30;
  return spec;
}

GroupErrors cross_validate(const FitSpec& kind,
                           const std::vector<Input>& inputs,
                           const TrainingRows& rows, const RowGroups& groups,
                           std::uint64_t seed, int threads = 0) {
  return group_errors(predict_unseen(kind, inputs, rows, groups, seed, threads),
                      rows.bias, groups);
}

TEST(CrossValidate, OfAConstantIsTheClosedForm) {
  // Two rows at m - d and m + d and one at m: the others' mean is the constant.
  const TrainingRows rows = rows_of(
      {{0, 0, 0.0, 10.0, 2}, {1, 1, 0.0, 10.0, 2}, {2, 2, 0.0, 10.0, 4}},
      [](double T, int k) {
        const double mean = k < 2 ? 1.0 : (k < 4 ? 4.0 : 10.0);
        return mean + 0.1 * (T - 5.0);
      });
  const GroupErrors errors = cross_validate(
      ConstantSpec{}, kTemperature, rows, group_rows(rows, Grouping::kRun), 1);
  // Within a group 0.1^2 mean((T - 5)^2): T - 5 is +-5, or +-5 and +-5/3.
  const double two = 0.25, four = 0.25 * (1.0 + 1.0 / 9.0) / 2.0;
  EXPECT_NEAR(errors(0), two + std::pow(1.0 - 8.0, 2), 1e-12);
  EXPECT_NEAR(errors(1), two + std::pow(4.0 - 7.0, 2), 1e-12);
  EXPECT_NEAR(errors(2), four + std::pow(10.0 - 2.5, 2), 1e-12);
}

// E(d) = mean((r + d)^2) if and only if the prediction of a group stays the
// same when its own bias moves by d.
TEST(CrossValidate, NeverFitsTheGroupItPredicts) {
  const auto error = [](const FitSpec& kind, double d) {
    const TrainingRows rows = rows_of(sweeps(4, 40), [&](double T, int k) {
      return bias_curve(T) + (k >= 80 && k < 120 ? d : 0.0);
    });
    return cross_validate(kind, kTemperature, rows,
                          group_rows(rows, Grouping::kRun), 1)(2);
  };
  for (const FitSpec& kind : {FitSpec{PolynomialSpec{3}}, FitSpec{SplineSpec{}},
                              FitSpec{small_network()}})
    EXPECT_NEAR(error(kind, 5.0) + error(kind, -5.0) - 2.0 * error(kind, 0.0),
                50.0, 1e-9)
        << method_name(kind);
}

TEST(CrossValidate, ClampsToTheTemperaturesOfTheOthersWhereNoneIsBetween) {
  const TrainingRows rows =
      rows_of({{0, 0, 0.0, 9.0, 10}, {1, 1, 11.0, 20.0, 10}},
              [](double T, int) { return T; });
  const GroupErrors errors =
      cross_validate(PolynomialSpec{1}, kTemperature, rows,
                     group_rows(rows, Grouping::kRun), 1);
  // Predicted by 11 and by 9: mean of 2^2 ... 11^2.
  EXPECT_NEAR(errors(0), 50.5, 1e-9);
  EXPECT_NEAR(errors(1), 50.5, 1e-9);
}

TEST(CrossValidate, ScoresWhatIsBetweenTheTemperaturesOfTheOthers) {
  const TrainingRows rows =
      rows_of({{0, 0, 0.0, 10.0, 11}, {1, 1, 5.0, 20.0, 16}},
              [](double T, int) { return T > 9.5 && T < 10.5 ? 7.0 : 0.0; });
  const BiasModel none{{Scale{}}, {}, NoBias{}};
  const RowGroups groups = group_rows(rows, Grouping::kRun);
  const GroupErrors errors =
      cross_validate(NoneSpec{}, kTemperature, rows, groups, 1);
  // The row at 10 degC, of 6 from 5 to 10 degC in either run.
  EXPECT_NEAR(errors(0), 49.0 / 6.0, 1e-12);
  EXPECT_NEAR(errors(1), 49.0 / 6.0, 1e-12);
  EXPECT_NEAR(group_errors(predict_all(none, rows), rows.bias, groups)(1),
              49.0 / 16.0, 1e-12);
}

TEST(CrossValidate, IsTheSameOnAnyNumberOfThreads) {
  const TrainingRows rows =
      rows_of(sweeps(4, 40), [](double T, int) { return bias_curve(T); });
  const auto unseen = [&](int threads) {
    return cross_validate(small_network(), kTemperature, rows,
                          group_rows(rows, Grouping::kRun), 1, threads);
  };
  const GroupErrors one = unseen(1);
  EXPECT_LT(rms_of(one), 1.0);
  for (const int threads : {2, 3, 16})
    EXPECT_TRUE((unseen(threads) == one).all()) << threads;
}

TEST(CrossValidate, TellsWhatWasHeldOutWhenAFoldCannotBeFitted) {
  // Without the first or the second run a line has one temperature.
  const TrainingRows rows =
      rows_of({{0, 0, 20.0, 30.0, 4}, {1, 1, 20.0, 20.0, 4}},
              [](double T, int) { return T; });
  const RowGroups groups = group_rows(rows, Grouping::kRun);
  const std::string message = rejection([&] {
    cross_validate(PolynomialSpec{1}, kTemperature, rows, groups, 1);
  });
  EXPECT_TRUE(message.starts_with("without run 1: temperature is between"))
      << message;
}

TEST(CrossValidate, NeedsTwoGroups) {
  const TrainingRows rows =
      rows_of(sweeps(1, 40), [](double T, int) { return T; });
  const std::string message = rejection([&] {
    cross_validate(ConstantSpec{}, kTemperature, rows,
                   group_rows(rows, Grouping::kCycle), 1);
  });
  EXPECT_EQ(message,
            "cross-validation by cycle needs two or more; the recordings have "
            "1");
}

TEST(StandardError, IsThatOfAMean) {
  // Deviations -2, 0, 2: variance 4, over 3 groups.
  EXPECT_NEAR(standard_error(errors_of({1.0, 3.0, 5.0})), std::sqrt(4.0 / 3.0),
              1e-15);
  EXPECT_TRUE(std::isinf(standard_error(errors_of({1.0}))));
  EXPECT_NEAR(rms_of(errors_of({1.0, 3.0, 5.0})), std::sqrt(3.0), 1e-15);
}

TEST(GroupErrors, AreMeansOverTheRowsOfEach) {
  const TrainingRows rows =
      rows_of({{0, 0, 0.0, 9.0, 2}, {1, 1, 0.0, 9.0, 3}},
              [](double, int k) { return k < 2 ? 3.0 : k - 3.0; });
  const BiasModel one{{Scale{}}, {}, ConstantBias{1.0}};
  const GroupErrors errors = group_errors(predict_all(one, rows), rows.bias,
                                          group_rows(rows, Grouping::kRun));
  EXPECT_NEAR(errors(0), 4.0, 1e-15);
  EXPECT_NEAR(errors(1), (4.0 + 1.0 + 0.0) / 3.0, 1e-15);
}

TEST(Choose, TakesTheFirstOfEqualOnes) {
  const GroupErrors same = errors_of({1.0, 2.0, 3.0});
  EXPECT_EQ(choose({same, same}), 0u);
  EXPECT_EQ(choose({same + 1.0, same, same}), 1u);
}

TEST(Choose, ExcusesTheAllowedExcessOfRms) {
  const GroupErrors best = errors_of({1.0, 1.0, 1.0, 1.0});
  const auto chosen = [&](double excess) {
    return choose({best + excess, best});
  };
  // Rms is allowed 1.02, mean square 1.0404.
  EXPECT_EQ(chosen(0.040), 0u);
  EXPECT_EQ(chosen(0.041), 1u);
}

// One curve for both runs, c = 0: b = T and b = s T, with T of mean square m.
// The weight is mean(s m, s m) / mean(m, s^2 m) = 2 s / (1 + s^2).
TEST(StackingWeight, FallsWhereGroupsDisagree) {
  const auto weight = [](double s) {
    const TrainingRows rows =
        rows_of({{0, 0, -9.0, 9.0, 19}, {1, 1, -9.0, 9.0, 19}},
                [&](double T, int k) { return k < 19 ? T : s * T; });
    const RowGroups groups = group_rows(rows, Grouping::kRun);
    const auto unseen = [&](const FitSpec& kind) {
      return predict_unseen(kind, kTemperature, rows, groups, 1);
    };
    return stacking_weight(unseen(ConstantSpec{}), unseen(PolynomialSpec{1}),
                           rows.bias, groups);
  };
  EXPECT_NEAR(weight(1.0).value, 1.0, 1e-12);
  EXPECT_NEAR(weight(1.0).standard_error, 0.0, 1e-12);
  EXPECT_NEAR(weight(0.5).value, 1.0 / 1.25, 1e-12);
  EXPECT_NEAR(weight(0.1).value, 0.2 / 1.01, 1e-12);
  // The products less w times the squares are +-s (1 - s^2)/(1 + s^2).
  EXPECT_NEAR(weight(0.5).standard_error, 0.75 / (1.25 * 1.25), 1e-12);
  EXPECT_NEAR(weight(0.1).standard_error, 0.2 * 0.99 / (1.01 * 1.01), 1e-12);
  EXPECT_EQ(weight(0.0).value, 0.0);
  EXPECT_EQ(weight(-1.0).value, 0.0);
}

TEST(StackingWeight, IsTheBestOfAllAverages) {
  const std::vector<double> noise = white(160, 4);
  const TrainingRows rows = rows_of(sweeps(4, 40), [&](double T, int k) {
    return 0.01 * std::floor(k / 40.0) * T + noise[static_cast<std::size_t>(k)];
  });
  const RowGroups groups = group_rows(rows, Grouping::kRun);
  const Predictions flat =
      predict_unseen(ConstantSpec{}, kTemperature, rows, groups, 1);
  const Predictions curve =
      predict_unseen(PolynomialSpec{1}, kTemperature, rows, groups, 1);
  const double best = stacking_weight(flat, curve, rows.bias, groups).value;
  const auto rms = [&](double weight) {
    return rms_of(
        group_errors(averaged(flat, curve, weight), rows.bias, groups));
  };
  EXPECT_GT(best, 0.0);
  EXPECT_LT(best, 1.0);
  for (const double weight : {0.0, best - 0.01, best + 0.01, 1.0})
    EXPECT_LT(rms(best), rms(weight)) << weight;
}

}  // namespace
}  // namespace beamgyro::internal::cross_validation_test
