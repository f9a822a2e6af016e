// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::warm_up_test {
namespace {

// Smallest time after which the bias stays within 5 % of its whole change.
double warm_up_time(const Recording& run) {
  const auto& bias = column_values(run, "true_bias");
  const double band = 0.05 * std::abs(bias.front() - bias.back());
  std::size_t k = bias.size();
  while (k > 0 && std::abs(bias[k - 1] - bias.back()) <= band) --k;
  return run.time[k];
}

TEST(Verification, V39WarmUpAt25DegC) {
  const Recording run =
      simulated(scenario_from("[noise]\nenabled = false\n",
                              "[ambient]\nconstant_degC = 25\n", "10800", "1"),
                verification_device());
  EXPECT_NEAR(column_values(run, "true_beam_temperature").back() - 25, 5.41,
              0.05);
  EXPECT_NEAR(warm_up_time(run) / 60, 23.8, 0.5);
}

TEST(WarmUp, ChangeOfTheBiasDependsOnTheAmbient) {
  const std::pair<const char*, double> table[] = {
      {"25", 0.20}, {"40", 0.22}, {"0", 0.64}, {"-30", 0.43}};
  for (const auto& [ambient, expected] : table) {
    const Recording run =
        simulated(scenario_from("[noise]\nenabled = false\n",
                                std::string("[ambient]\nconstant_degC = ") +
                                    ambient + "\n",
                                "7200", "1"),
                  verification_device());
    const auto& bias = column_values(run, "true_bias");
    const auto [low, high] = std::minmax_element(bias.begin(), bias.end());
    const double change = *high - *low;  // printed to two digits
    EXPECT_NEAR(change, expected, 0.01) << ambient << " degC";
  }
}

}  // namespace
}  // namespace beamgyro::internal::warm_up_test
