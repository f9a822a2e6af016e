// SPDX-License-Identifier: MIT
#include "sim/memory/ageing.h"

#include <cmath>
#include <numbers>

#include "sim/memory/gas_constant.h"

namespace beamgyro::internal {

double ageing_rate(double activation, double T) {
  return std::exp(-activation / kGasConstant *
                  (1 / T - 1 / kAgeingTemperature));
}

Ageing::Ageing(const AgeingParameters& parameters, double age)
    : parameters_(parameters), age_(age) {}

void Ageing::advance(double from, double to, double duration) {
  // Simpson's rule on at most 5 K: exact to 1e-7 for E_a up to 1e5 J/mol.
  constexpr double kWidest = 5;  // [K]
  const int parts = 1 + static_cast<int>(std::abs(to - from) / kWidest);
  const auto rate = [&](double place) {
    return ageing_rate(parameters_.activation,
                       std::lerp(from, to, place / parts));
  };
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    sum += (rate(i) + 4 * rate(i + 0.5) + rate(i + 1)) / 6;
  age_ += sum / parts * duration;
}

double Ageing::decades() const {
  const double after = (age_ - parameters_.trim_age) /
                       (parameters_.trim_age + parameters_.start);
  return std::log1p(after) / std::numbers::ln10;
}

}  // namespace beamgyro::internal
