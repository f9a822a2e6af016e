// SPDX-License-Identifier: MIT
#include "validation/metrics/no_effect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::no_effect_test {
namespace {

using Correction = std::function<double(double temperature)>;

// A gyro with a drift of 0.1 deg/s/K over so many kelvins, and what is said of
// a compensator that takes a function of the temperature away.
std::string words(double kelvin, double slope, const Correction& correction) {
  RecordedRun made{.duration = 3600.0, .step = 1.0};
  made.temperature = [=](double t) { return kelvin * t / 3600.0; };
  made.bias = [=, T = made.temperature](double t) {
    return 2.0 + slope * T(t);
  };
  const Recording run = made.recording();
  const auto& rate = column_values(run, "rate");
  std::vector<double> answers;
  for (std::size_t k = 0; k < rate.size(); ++k)
    answers.push_back(rate[k] - correction(made.temperature(run.time[k])));
  const auto evidence = [&run](const std::vector<double>& one) {
    return Evidence{{{"run", RunPurpose::kSoak, &run, one}}};
  };
  return words_of_no_effect(evidence(rate), evidence(answers));
}

TEST(WordsOfNoEffect, AreOfTheRecordedRateAndOfItLessAConstant) {
  const auto nothing = [](double) { return 0.0; };
  const auto constant = [](double) { return 1.5; };
  EXPECT_TRUE(holds(words(30.0, 0.1, nothing), "The compensator does nothing"));
  EXPECT_TRUE(holds(words(30.0, 0.1, constant), "one constant, 1.5 deg/s"));
  // Within 9 K a sound compensator may have nothing to do.
  EXPECT_EQ(words(9.0, 0.1, nothing), "");
}

TEST(WordsOfNoEffect, AreNotOfWhatFollowsTheTemperature) {
  const auto line = [](double slope) {
    return [slope](double T) { return slope * T; };
  };
  EXPECT_EQ(words(30.0, 0.1, line(0.1)), "");
  EXPECT_EQ(words(30.0, 0.1, line(1e-4)), "");
  // A gyro that drifts by 1e-6 deg/s/K, and one that corrects all of that.
  EXPECT_EQ(words(30.0, 1e-6, line(1e-6)), "");
  // Less than single precision resolves of a rate.
  EXPECT_NE(words(30.0, 0.1, line(1e-7)), "");
  EXPECT_EQ(words(30.0, 0.1, [](double) { return std::nan(""); }), "");
}

}  // namespace
}  // namespace beamgyro::internal::no_effect_test
