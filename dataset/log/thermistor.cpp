// SPDX-License-Identifier: MIT
#include "dataset/log/thermistor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "config/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kNominal = 25;  // [degC], at which R25 is stated

std::array<double, 3> read_coefficients(const ConfigTable& table) {
  constexpr const char* kThree = "steinhart_hart";
  if (table.has(kThree)) {
    std::array<double, 3> coefficients{};
    std::ranges::copy(table.numbers(kThree, coefficients.size()),
                      coefficients.begin());
    if (!(coefficients[1] > 0))
      table.fail(kThree,
                 "the second number is not above 0; expected [A, B, C] of "
                 "1/T = A + B ln R + C (ln R)^3 with R in ohm");
    return coefficients;
  }
  const double b = 1 / table.number("beta_K", between(100, 1e5));
  const double r25 = table.number("resistance_25_ohm", positive());
  return {1 / (kNominal + kZeroCelsius) - b * std::log(r25), b, 0};
}

}  // namespace

double VoltageDivider::resistance(double reading) const {
  const double share = reading / full_scale;
  if (!(share > 0 && share < 1)) return kNoNumber;
  return series * (at_ground ? share / (1 - share) : (1 - share) / share);
}

double Thermistor::temperature(double reading) const {
  const double r = divider ? divider->resistance(reading) : reading;
  if (!(r > 0)) return kNoNumber;
  const double log_r = std::log(r);
  const auto& [a, b, c] = coefficients;
  const double inverse = a + log_r * (b + c * log_r * log_r);
  return inverse > 0 ? 1 / inverse - kZeroCelsius : kNoNumber;
}

Thermistor read_thermistor(const ConfigTable& table, bool is_resistance) {
  Thermistor thermistor{read_coefficients(table), std::nullopt};
  if (is_resistance) return thermistor;
  thermistor.divider = VoltageDivider{
      table.number("series_ohm", positive()),
      table.number("full_scale", positive()),
      table.choice("side", {"ground", "supply"}) == std::string("ground")};
  return thermistor;
}

}  // namespace beamgyro::internal
