// SPDX-License-Identifier: MIT
#include "tests/compensation/recorded_run.h"

#include <cmath>
#include <limits>

namespace beamgyro::internal {

Recording RecordedRun::recording() const {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto samples = static_cast<std::size_t>(std::floor(duration / step));
  Recording run;
  std::vector<double> rate;
  std::vector<double> output;
  std::vector<double> sensed;
  std::vector<double> truth;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = static_cast<double>(k) * step;
    const bool on = powered(t);
    run.time.push_back(t);
    run.status.push_back(on ? 0 : kUnpowered);
    truth.push_back(true_rate(t));
    rate.push_back(on ? scale_factor(t) * true_rate(t) + bias(t) : nan);
    output.push_back(on ? 2.5 + 0.0125 * rate.back() : nan);
    sensed.push_back(on ? temperature(t) : nan);
  }
  run.columns = {
      {"output", "V", "output", Role::kMeasured, output},
      {"rate", "degree/s", "rate", Role::kMeasured, rate},
      {"temperature", "degC", "temperature", Role::kMeasured, sensed},
      {"true_rate", "degree/s", "true rate", Role::kTruth, truth}};
  return run;
}

SignalOfTime rate_table(double full_scale, int rates, double hold) {
  return [=](double t) {
    const auto step = static_cast<int>(std::floor(t / hold)) % rates;
    return full_scale * (2.0 * step / (rates - 1) - 1.0);
  };
}

}  // namespace beamgyro::internal
