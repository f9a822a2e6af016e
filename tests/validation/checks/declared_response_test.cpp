// SPDX-License-Identifier: MIT
// Firmware that rounds, filters, starts up and zeroes itself: it passes when it
// says so, is told what to say when it does not, and fails when it says what
// it does not do.
#include "validation/checks/declared_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "compensation/inputs/sample_ranges.h"
#include "tests/validation/checks/simulated_runs.h"

namespace beamgyro::internal::declared_response_test {
namespace {

using Names = std::vector<std::string>;
using Function = FunctionCompensator::Function;

std::vector<double> sound(const Recording& run) {
  return compensated_rate(trained("spline"), run);
}

/// Sound answers, each replaced by what `step` makes of time since power-on
/// [s], step [s], recorded rate and answer [deg/s].
template <class Make>
Function firmware(const Make& make) {
  return [make](const Recording& run) {
    std::vector<double> answers = sound(run);
    const auto& rate = column_values(run, "rate");
    for (const SampleRange& stretch : powered_stretches(run)) {
      auto step = make();
      for (std::size_t k = stretch.begin; k < stretch.end; ++k)
        answers[k] = step(run.time[k] - run.time[stretch.begin],
                          k > stretch.begin ? run.time[k] - run.time[k - 1] : 0,
                          rate[k], answers[k]);
    }
    return answers;
  };
}

Function rounded_to(double step) {
  return firmware([step] {
    return [step](double, double, double, double y) {
      return step * std::round(y / step);
    };
  });
}

double to_half(double y) {
  int exponent = 0;
  const double fraction = std::frexp(y, &exponent);
  return std::ldexp(std::round(std::ldexp(fraction, 11)), exponent - 11);
}

Function low_pass(double bandwidth) {
  return firmware([bandwidth] {
    return [bandwidth, low = std::nan("")](double, double step, double,
                                           double y) mutable {
      const double share =
          -std::expm1(-step * 2.0 * std::numbers::pi * bandwidth);
      low = std::isnan(low) ? y : low + share * (y - low);
      return low;
    };
  });
}

Function moving_average(std::size_t samples) {
  return firmware([samples] {
    return [samples, last = std::deque<double>()](double, double, double,
                                                  double y) mutable {
      last.push_back(y);
      if (last.size() > samples) last.pop_front();
      double sum = 0.0;
      for (const double one : last) sum += one;
      return sum / static_cast<double>(last.size());
    };
  });
}

Function median_of_three() {
  return firmware([] {
    return [last = std::deque<double>()](double, double, double,
                                         double y) mutable {
      last.push_back(y);
      if (last.size() > 3) last.pop_front();
      std::vector<double> sorted(last.begin(), last.end());
      std::ranges::sort(sorted);
      return sorted[sorted.size() / 2];
    };
  });
}

// Steady after some samples: a random walk of the rate.
Function kalman() {
  return firmware([] {
    return [estimate = std::nan(""), variance = 1e-3](
               double, double step, double, double y) mutable {
      variance += 50.0 * step;
      const double gain = variance / (variance + 0.2);
      estimate = std::isnan(estimate) ? y : estimate + gain * (y - estimate);
      variance *= 1.0 - gain;
      return estimate;
    };
  });
}

Function zeroed() {
  return firmware([] {
    return [sum = 0.0, samples = 0.0](double since, double, double,
                                      double y) mutable {
      if (since <= 10.0) {
        sum += y;
        samples += 1.0;
      }
      return y - sum / samples;
    };
  });
}

Function silent_for(double seconds, double answer) {
  return firmware([seconds, answer] {
    return [seconds, answer](double since, double, double, double y) {
      return since < seconds ? answer : y;
    };
  });
}

CheckedCompensator declared(const TestedCompensator& compensator,
                            const DeclaredResponse& response) {
  CheckedCompensator all = checked(compensator);
  all.declared = response;
  return all;
}

struct Firmware {
  const char* name;
  Function answers;
  DeclaredResponse declared;
  bool passes_undeclared = false;
};

std::vector<Firmware> honest() {
  return {
      {"three decimals", rounded_to(1e-3), {}, true},
      {"four decimals", rounded_to(1e-4), {}, true},
      {"int16 of 250 deg/s", rounded_to(250.0 / 32768.0), {}, true},
      {"two decimals", rounded_to(0.01), {}, true},
      {"one decimal", rounded_to(0.1), {.resolution = 0.1}},
      {"half precision",
       firmware([] {
         return [](double, double, double, double y) { return to_half(y); };
       }),
       {.resolution = 0.125}},
      {"low-pass", low_pass(2.0), {.bandwidth = 1.9}},
      {"moving average", moving_average(3), {.bandwidth = 1.4, .delay = 0.11}},
      {"median", median_of_three(), {.bandwidth = 2.0, .delay = 0.11}},
      {"Kalman filter", kalman(), {.bandwidth = 2.0}},
      {"zeroing", zeroed(), {.zeroes_at_power_on = 10.0}},
      {"zero at first", silent_for(10.0, 0.0), {.ready_after = 10.0}},
      {"nothing at first",
       silent_for(10.0, std::nan("")),
       {.ready_after = 10.0}},
      {"nothing for a minute, rounded",
       [](const Recording& run) {
         std::vector<double> answers = silent_for(60.0, -1.0)(run);
         for (double& y : answers) y = 0.05 * std::round(y / 0.05);
         return answers;
       },
       {.ready_after = 60.0, .resolution = 0.05}},
  };
}

TEST(DeclaredResponse, HonestFirmwarePassesWhenDeclared) {
  for (const Firmware& one : honest()) {
    const FunctionCompensator compensator(one.answers);
    for (const CheckResult& result :
         run_checks(declared(compensator, one.declared)))
      EXPECT_NE(result.outcome, CheckOutcome::kFailed)
          << one.name << ": " << result.name << ": " << result.words;
  }
}

TEST(DeclaredResponse, UndeclaredFirmwareIsToldWhatToDeclare) {
  for (const Firmware& one : honest()) {
    const FunctionCompensator compensator(one.answers);
    std::string words;
    Names failed;
    for (const CheckResult& result : run_checks(checked(compensator)))
      if (result.outcome == CheckOutcome::kFailed) {
        failed.push_back(result.name);
        words += result.words;
      }
    EXPECT_EQ(failed.empty(), one.passes_undeclared) << one.name << words;
    EXPECT_EQ(words.find("With [declared] ") != std::string::npos,
              !one.passes_undeclared)
        << one.name << ": " << words;
  }
}

TEST(DeclaredResponse, AFalseDeclarationFails) {
  const std::vector<Firmware> false_ones = {
      {"coarser than it is", sound, {.resolution = 0.1}},
      {"a zeroing that is none", sound, {.zeroes_at_power_on = 10.0}},
      {"ready from the begin", sound, {.ready_after = 10.0}},
      {"wider than it is", low_pass(1.0), {.bandwidth = 4.0}},
      {"faster than it is", moving_average(9), {.delay = 0.1}},
      {"finer than it is", rounded_to(0.2), {.resolution = 0.05}},
  };
  for (const Firmware& one : false_ones) {
    const FunctionCompensator compensator(one.answers);
    EXPECT_FALSE(failed_checks(declared(compensator, one.declared)).empty())
        << one.name;
  }
}

// What eats rates is found behind every declaration that there may be.
TEST(DeclaredResponse, NoDeclarationHidesAnEatenRate) {
  const auto high_pass = firmware([] {
    return [low = 0.0](double, double step, double, double y) mutable {
      low += (y - low) * std::min(1.0, step / 100.0);
      return y - low;
    };
  });
  const Function network = [](const Recording& run) {
    return compensated_rate(trained("output_and_temperature"), run);
  };
  const Function scaled = [](const Recording& run) {
    std::vector<double> answers = sound(run);
    for (double& value : answers) value *= 0.99;
    return answers;
  };
  const std::vector<DeclaredResponse> loosest = {
      {.bandwidth = 1.0, .delay = 0.5},
      {.ready_after = 60.0},
      {.zeroes_at_power_on = 60.0},
      {.bandwidth = 1.0,
       .delay = 0.5,
       .ready_after = 60.0,
       .zeroes_at_power_on = 60.0}};
  for (const Function& cheat : {Function(high_pass), network, scaled}) {
    const FunctionCompensator compensator(cheat);
    for (const DeclaredResponse& response : loosest) {
      const Names failed = failed_checks(declared(compensator, response));
      EXPECT_TRUE(std::ranges::count(failed, "jacobian") > 0 ||
                  std::ranges::count(failed, "injection") > 0)
          << response.words();
    }
  }
}

TEST(DeclaredResponse, BoundsOfALowPassOfFirstOrder) {
  const DeclaredResponse response{.bandwidth = 10.0, .delay = 0.01};
  EXPECT_NEAR(response.least_gain(10.0), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(response.most_delay(10.0), 0.01 + 1.0 / 80.0, 1e-15);
  EXPECT_EQ(DeclaredResponse{}.least_gain(10.0), 1.0);
  EXPECT_EQ(DeclaredResponse{}.settling(100.0), 1.0);
  EXPECT_EQ(response.settling(2.0), 6.0);
  EXPECT_EQ(response.words(), "bandwidth_Hz = 10, delay_s = 0.01");
}

}  // namespace
}  // namespace beamgyro::internal::declared_response_test
