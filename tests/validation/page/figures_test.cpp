// SPDX-License-Identifier: MIT
#include "validation/page/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compensation/scoring/allan_deviation.h"
#include "random/random_stream.h"
#include "validation/page/page.h"

namespace beamgyro::internal::figures_test {

constexpr double kPi = std::numbers::pi;
// Figures have six significant digits.
constexpr double kSixDigits = 1e-5;  // [-]

using Signal = std::function<double(double)>;  // of time [s]

/// A run whose every signal is given.
struct GivenRun {
  std::string name;
  RunPurpose purpose;
  double seconds, rate_Hz;
  Signal temperature, true_rate, bias_before, bias_after;
};

double none(double) { return 0.0; }

/// The runs before and after; recordings keep their addresses.
struct GivenEvidence {
  std::deque<Recording> recordings;
  Evidence before, after;

  void add(const GivenRun& run) {
    Recording& made = recordings.emplace_back();
    std::vector<double> temperature, truth, before_rate, after_rate;
    const auto count = static_cast<std::size_t>(run.seconds * run.rate_Hz);
    for (std::size_t k = 0; k < count; ++k) {
      const double t = static_cast<double>(k) / run.rate_Hz;
      made.time.push_back(t);
      temperature.push_back(run.temperature(t));
      truth.push_back(run.true_rate(t));
      before_rate.push_back(truth.back() + run.bias_before(t));
      after_rate.push_back(truth.back() + run.bias_after(t));
    }
    made.status.assign(count, 0);
    made.columns = {{"temperature", "degC", "", Role::kMeasured, temperature},
                    {"true_rate", "degree/s", "", Role::kTruth, truth}};
    before.runs.push_back({run.name, run.purpose, &made, before_rate});
    after.runs.push_back({run.name, run.purpose, &made, after_rate});
  }

  nlohmann::ordered_json figure(const std::string& id) const {
    for (const auto& each : figures_of(before, after))
      if (each.at("id") == id) return each;
    throw std::out_of_range("no figure " + id);
  }
};

/// Soaks of an hour at these temperatures.
Signal soaks(const std::vector<double>& temperatures) {
  return [=](double t) {
    return temperatures.at(static_cast<std::size_t>(t / 3600.0));
  };
}

TEST(Figures, BiasOverTemperatureHasEverySoakInItsDirection) {
  GivenEvidence given;
  const Signal temperature = soaks({-30, 0, 30, 0, -30});
  given.add({"soaks", RunPurpose::kSoak, 5 * 3600.0, 0.1, temperature, none,
             [&](double t) { return 0.1 * temperature(t); },
             [](double t) { return t < 3 * 3600.0 ? 0.25 : -0.25; }});
  const auto figure = given.figure("bias_over_temperature");
  ASSERT_EQ(figure["series"].size(), 4u);
  const std::vector<double> up = {-30, 0, 30}, down = {0, -30};
  EXPECT_EQ(figure["series"][0]["name"], "before, rising");
  EXPECT_EQ(figure["series"][0]["x"].get<std::vector<double>>(), up);
  EXPECT_EQ(figure["series"][0]["y"].get<std::vector<double>>(),
            (std::vector<double>{-3, 0, 3}));
  EXPECT_EQ(figure["series"][1]["x"].get<std::vector<double>>(), down);
  EXPECT_EQ(figure["series"][2]["y"].get<std::vector<double>>(),
            (std::vector<double>{0.25, 0.25, 0.25}));
  EXPECT_EQ(figure["series"][3]["y"].get<std::vector<double>>(),
            (std::vector<double>{-0.25, -0.25}));
  // The compensated rate is shown again by itself, being much smaller.
  EXPECT_EQ(given.figure("bias_over_temperature_after")["series"].size(), 2u);
}

TEST(Figures, ACompensatorThatChangesNothingHasNoCloseUp) {
  GivenEvidence given;
  const Signal temperature = soaks({-30, 0, 30});
  given.add({"soaks", RunPurpose::kSoak, 3 * 3600.0, 0.1, temperature, none,
             temperature, temperature});
  EXPECT_NO_THROW(given.figure("bias_over_temperature"));
  EXPECT_THROW(given.figure("bias_over_temperature_after"), std::out_of_range);
}

TEST(Figures, AHysteresisLoopIsDividedWhereTheRampTurns) {
  GivenEvidence given;
  const auto rising = [](double t) { return t < 3600.0; };
  given.add({"ramp", RunPurpose::kRamp, 7200, 1,
             [&](double t) { return (rising(t) ? t : 7200.0 - t) / 60.0; },
             none, [&](double t) { return rising(t) ? 2.0 : 1.0; }, none});
  const auto figure = given.figure("hysteresis");
  EXPECT_EQ(figure["series"][0]["name"], "before, ramp, rising");
  // A block or two at the turn belongs to either.
  for (std::size_t k = 0; k < 2; ++k) {
    const auto y = figure["series"][k]["y"].get<std::vector<double>>();
    EXPECT_NEAR(static_cast<double>(y.size()), 60.0, 2.0);
    EXPECT_EQ(y[y.size() / 2], k == 0 ? 2.0 : 1.0);
  }
}

TEST(Figures, AWarmUpStartsAtItsDifferenceFromTheEnd) {
  GivenEvidence given;
  given.add({"cold", RunPurpose::kWarmUp, 3600, 1, soaks({-20}), none,
             [](double t) { return t < 1800.0 ? 1.5 : 0.5; }, none});
  const auto figure = given.figure("warm_up");
  EXPECT_EQ(figure["series"][0]["name"], "before, cold (from -20 degC)");
  EXPECT_EQ(figure["series"][0]["y"].front(), 1.0);
  EXPECT_EQ(figure["series"][0]["y"].back(), 0.0);
  EXPECT_LE(figure["series"][0]["x"].size(), kFigurePoints);
}

TEST(Figures, RateTableResidualsAreDeparturesFromTheLine) {
  GivenEvidence given;
  // -100 ... 100 deg/s after a warm-up at rest, a minute each.
  const Signal rate = [](double t) {
    return t < 3600.0 ? 0.0 : 50.0 * std::floor((t - 3600.0) / 60.0) - 100.0;
  };
  // Slope 1.001, curvature c: the departure of c Omega^2 from its mean over
  // the five rates, c (Omega^2 - 5000).
  given.add({"table", RunPurpose::kRateTable, 3900, 2, soaks({20, 20}), rate,
             [&](double t) {
               return 0.3 + 1e-3 * rate(t) + 1e-6 * rate(t) * rate(t);
             },
             none});
  const auto series = given.figure("rate_table_before")["series"][0];
  EXPECT_EQ(series["name"], "20 degC");
  ASSERT_EQ(series["x"].get<std::vector<double>>(),
            (std::vector<double>{-100, -50, 0, 50, 100}));
  for (std::size_t k = 0; k < 5; ++k) {
    const double omega = series["x"][k];
    const double expected =
        1e6 * 1e-6 * (omega * omega - 5000.0) / (1.001 * 100.0);
    EXPECT_NEAR(series["y"][k], expected, kSixDigits * 100.0);
  }
  const auto slope = given.figure("scale_factor_over_temperature")["series"];
  EXPECT_NEAR(slope[0]["y"][0], 1000.0, kSixDigits * 1000.0);
  EXPECT_NEAR(slope[1]["y"][0], 0.0, 1e-6);  // rounding of sums
}

TEST(Figures, TheFrequencyResponseHasGainAndPhase) {
  GivenEvidence given;
  for (const double f : {0.5, 5.0}) {
    const auto sine = [=](double phase) {
      return [=](double t) {
        return 3.0 + 10.0 * std::sin(2.0 * kPi * f * t + phase);
      };
    };
    // Half the amplitude and 0.4 rad late, beside a drifting bias.
    given.add(
        {"sine", RunPurpose::kSineRate, 4.0 + 4.0 / f, 100 * f, soaks({20}),
         sine(0.0),
         [=](double t) { return 0.5 * sine(-0.4)(t) - sine(0.0)(t) + 0.2 * t; },
         none});
  }
  const auto gain = given.figure("frequency_response_gain")["series"];
  const auto phase = given.figure("frequency_response_phase")["series"];
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(gain[0]["x"][k], k == 0 ? 0.5 : 5.0, kSixDigits * 5.0);
    EXPECT_NEAR(gain[0]["y"][k], 20.0 * std::log10(0.5), kSixDigits * 10.0);
    EXPECT_NEAR(phase[0]["y"][k], -0.4 * 180.0 / kPi, kSixDigits * 30.0);
    EXPECT_NEAR(gain[1]["y"][k], 0.0, 1e-6);
  }
}

TEST(Figures, AResponseEndsAtAHundredthOfTheRate) {
  GivenEvidence given;
  for (const auto& [f, gain] : {std::pair(1.0, 0.5), std::pair(2.0, 0.005)}) {
    const Signal sine = [f = f](double t) {
      return std::sin(2.0 * kPi * f * t);
    };
    given.add({"sine", RunPurpose::kSineRate, 8, 100, soaks({20}), sine,
               [=, gain = gain](double t) { return (gain - 1.0) * sine(t); },
               none});
  }
  const auto series = given.figure("frequency_response_gain")["series"];
  EXPECT_EQ(series[0]["x"].size(), 1u);
  EXPECT_EQ(series[1]["x"].size(), 2u);
}

TEST(Figures, AStepIsShownAroundItself) {
  GivenEvidence given;
  const auto step = [](double after) {
    return [=](double t) { return t < after ? 0.0 : 10.0; };
  };
  given.add({"step", RunPurpose::kRateStep, 10, 1000, soaks({20}), step(5.0),
             [&](double t) { return step(5.01)(t) - step(5.0)(t); }, none});
  const auto series = given.figure("rate_step")["series"];
  EXPECT_EQ(series[2]["name"], "true rate");
  const auto first_high = [](const nlohmann::ordered_json& of) {
    std::size_t k = 0;
    while (of["y"][k] < 5.0) ++k;
    return of["x"][k].get<double>();
  };
  EXPECT_NEAR(first_high(series[0]), 10.0, 1e-3);  // [ms]
  EXPECT_NEAR(first_high(series[1]), 0.0, 1e-3);
}

TEST(Figures, AnAllanDeviationOfWhiteNoiseLiesOnItsLine) {
  constexpr double kWalk = 0.01;  // [deg/sqrt(s)]
  GivenEvidence given;
  RandomStream stream(7, 0, 0, RandomPurpose{1});
  given.add({"rest", RunPurpose::kRest, 3600, 10, soaks({20}), none,
             [&](double) { return kWalk * std::sqrt(10.0) * stream.normal(); },
             none});
  GivenEvidence swapped;  // fits are of the compensated rate
  swapped.before = given.after;
  swapped.after = given.before;
  const auto series = swapped.figure("allan")["series"];
  const auto& line = series.back();
  EXPECT_EQ(line["name"], "after: angle random walk");
  for (std::size_t k = 0; k < line["x"].size(); ++k)
    // N of 36,000 samples has a 1-sigma of about 0.5 %.
    EXPECT_NEAR(line["y"][k], kWalk / std::sqrt(line["x"][k].get<double>()),
                0.02 * line["y"][k].get<double>());
  // Whiskers are the intervals of the deviations.
  const auto& rate = given.before.runs[0].rate;
  const auto points =
      allan_curve(rate, 0.1, octave_taus(rate.size(), 0.1)).overlapping;
  ASSERT_EQ(series[1]["x"].size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [low, high] = points[k].interval;
    EXPECT_NEAR(series[1]["low"][k], low, kSixDigits * low);
    EXPECT_NEAR(series[1]["high"][k], high, kSixDigits * high);
  }
}

TEST(Figures, TheHistogramHoldsEveryMinute) {
  GivenEvidence given;
  given.add({"warm_up", RunPurpose::kWarmUp, 36000, 1,
             [](double) { return 20; }, none, none,
             [](double t) { return t / 36000.0; }});
  const auto bars = given.figure("residual_histogram")["series"][0];
  double sum = 0.0;
  for (const double share : bars["y"]) sum += share;
  EXPECT_NEAR(sum, 100.0, kSixDigits * 100.0);
  EXPECT_EQ(bars["kind"], "bars");
}

TEST(Figures, WhatIsNotANumberIsLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  GivenEvidence given;
  given.add({"ramp", RunPurpose::kRamp, 7200, 1,
             [](double t) { return t / 60.0; }, none, none,
             [=](double) { return nan; }});
  for (const auto& figure : figures_of(given.before, given.after))
    for (const auto& series : figure["series"]) {
      EXPECT_NE(series["role"], "after") << figure["id"];
      for (const auto& y : series["y"]) EXPECT_TRUE(y.is_number());
    }
}

TEST(Figures, WithoutRunsThereIsNone) {
  EXPECT_TRUE(figures_of({}, {}).empty());
}

TEST(Figures, NeedTheSameRunsAndARateForEveryTime) {
  GivenEvidence given;
  given.add(
      {"a", RunPurpose::kSoak, 7200, 1, soaks({20, 20, 20}), none, none, none});
  EXPECT_THROW(figures_of(given.before, {}), std::invalid_argument);
  given.after.runs[0].rate.pop_back();
  EXPECT_THROW(figures_of(given.before, given.after), std::invalid_argument);
}

TEST(Figures, AYieldRisesToTheShareOfDevicesThatHaveAFigure) {
  std::vector<double> before, after;
  for (int k = 1; k <= 1000; ++k) before.push_back(k);
  after = {0.1, std::numeric_limits<double>::quiet_NaN(), 0.3, 0.2};
  const auto figure = population_figure(
      {find_metric("bias_pp_deg_per_s"), before, after}, 0.25);
  EXPECT_EQ(figure["x"]["label"], "Bias pp");
  EXPECT_EQ(figure["x"]["scale"], "log");
  EXPECT_LE(figure["series"][0]["x"].size(), kFigurePoints + 1);
  EXPECT_EQ(figure["series"][0]["y"].back(), 100.0);
  EXPECT_EQ(figure["series"][1]["x"].get<std::vector<double>>(),
            (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(figure["series"][1]["y"].get<std::vector<double>>(),
            (std::vector<double>{25, 50, 75}));
  EXPECT_EQ(figure["series"][2]["role"], "limit");
}

}  // namespace beamgyro::internal::figures_test
