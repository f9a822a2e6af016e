// SPDX-License-Identifier: MIT
#include "sim/stepper/thermal_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

ThermalOde ode_of(const TrimmedGyro& gyro) {
  const DriveHeating heating = drive_heating(gyro);
  return {ThermalNetwork(gyro.device.thermal), heating.mechanical,
          heating.dielectric};
}

// An upper bound of the fastest rate [1/s]: the largest row sum of the
// Jacobian, of which the larger one counts of a housing far from its
// surroundings and of an oven in its linear range.
double fastest_rate(const ThermalOde& ode, const TrimmedGyro& gyro,
                    bool stirred) {
  constexpr double kFar = 100;  // [K]
  Eigen::VectorXd y =
      Eigen::VectorXd::Constant(ode.size(), kCalibrationTemperature);
  if (const auto& oven = gyro.device.thermal.oven) {
    y(kMount) = oven->set_point;
    y(kThermalNodeCount) = oven->max_power / 2;
  }
  Eigen::MatrixXd slope(ode.size(), ode.size());
  ode.jacobian({kCalibrationTemperature - kFar, stirred}, true, y, slope);
  return slope.cwiseAbs().rowwise().sum().maxCoeff();
}

}  // namespace

ThermalStepper::ThermalStepper(const TrimmedGyro& gyro, bool stirred)
    : ode_(ode_of(gyro)), oven_(gyro.device.thermal.oven), stirred_(stirred) {
  // The method is stable up to 2.785 over the fastest rate. The heat flow of
  // slow nodes is exact enough with steps of kLongest.
  constexpr double kStable = 1.5, kLongest = 0.1, kShortest = 1e-4;  // [s]
  longest_ = std::min(kLongest, kStable / fastest_rate(ode_, gyro, stirred));
  if (longest_ < kShortest)
    throw SimulationFailure(fmt::format(
        "thermal network: its fastest node takes steps of {:.2g} s; expected "
        "{:g} s or more, which larger heat capacities or smaller conductances "
        "and gains give",
        longest_, kShortest));
}

std::int64_t ThermalStepper::parts(double duration) const {
  return static_cast<std::int64_t>(
      std::max(1.0, std::ceil(duration / longest_ * (1 - 1e-9))));
}

ThermalStepper::State ThermalStepper::rate(const State& y, double ambient,
                                           bool powered) const {
  State dydt = State::Zero();
  ode_.rate({ambient, stirred_}, powered, y.head(ode_.size()),
            dydt.head(ode_.size()));
  return dydt;
}

// Tells the ranges of an oven apart between which its right-hand side bends.
int ThermalStepper::oven_range(const State& y) const {
  const OvenAction action =
      oven_action(*oven_, y(kMount), y(kThermalNodeCount));
  return (action.power == 0 ? 1 : 0) + (action.power_per_integral > 0 ? 2 : 0) +
         (action.integral_rate == 0 ? 4 : 0) +
         (action.integral_rate_per_integral != 0 ? 8 : 0);
}

ThermalStepper::State ThermalStepper::stepped(const State& y, double from,
                                              double to, bool powered,
                                              double duration) const {
  constexpr double kShortest = 2e-3;  // [s]
  const State next = runge_kutta(y, from, to, powered, duration);
  if (!oven_ || !powered || duration < kShortest ||
      oven_range(y) == oven_range(next))
    return next;
  const double middle = 0.5 * (from + to);
  return stepped(stepped(y, from, middle, powered, duration / 2), middle, to,
                 powered, duration / 2);
}

ThermalStepper::State ThermalStepper::runge_kutta(const State& y, double from,
                                                  double to, bool powered,
                                                  double duration) const {
  const double h = duration, middle = 0.5 * (from + to);
  const State k1 = rate(y, from, powered);
  const State k2 = rate(y + h / 2 * k1, middle, powered);
  const State k3 = rate(y + h / 2 * k2, middle, powered);
  const State k4 = rate(y + h * k3, to, powered);
  return y + h / 6 * (k1 + 2 * (k2 + k3) + k4);
}

}  // namespace beamgyro::internal
