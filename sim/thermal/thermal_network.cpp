// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_network.h"

#include <cmath>

#include "linear_algebra/linear_systems.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

constexpr double kStefanBoltzmann = 5.670374419e-8;  // [W/(m^2 K^4)], CODATA

NodeMatrix conductance_matrix(const ThermalParameters& p) {
  NodeMatrix matrix = NodeMatrix::Zero();
  const auto join = [&](ThermalNode a, ThermalNode b, double conductance) {
    matrix(a, a) += conductance;
    matrix(b, b) += conductance;
    matrix(a, b) -= conductance;
    matrix(b, a) -= conductance;
  };
  join(kBeam, kPzt, p.beam_pzt_conductance);
  join(kBeam, kMount, p.beam_mount_conductance);
  join(kBeam, kHousing, p.beam_housing_conductance);
  join(kMount, kHousing, p.mount_housing_conductance);
  join(kHousing, kBoard, p.housing_board_conductance);
  join(kBoard, kSensor, p.board_sensor_conductance);
  join(kHousing, kSensor, p.housing_sensor_conductance);
  return matrix;
}

double fourth_root(double x) { return std::sqrt(std::sqrt(x)); }

}  // namespace

ThermalNetwork::ThermalNetwork(const ThermalParameters& parameters)
    : parameters_((require_valid(parameters), parameters)),
      conductance_(conductance_matrix(parameters)),
      natural_coefficient_(parameters.natural_convection_coefficient *
                           parameters.housing_area /
                           fourth_root(parameters.housing_height)),
      radiation_coefficient_(parameters.housing_emissivity * kStefanBoltzmann *
                             parameters.housing_area),
      forced_conductance_(parameters.stirred_convection *
                          parameters.housing_area) {
  heat_capacity_ << parameters.beam_heat_capacity, parameters.pzt_heat_capacity,
      parameters.mount_heat_capacity, parameters.housing_heat_capacity,
      parameters.board_heat_capacity, parameters.sensor_heat_capacity;
}

NodeVector ThermalNetwork::powered_heating(double mechanical,
                                           double dielectric) const {
  NodeVector power = NodeVector::Zero();
  power(kBeam) = mechanical;
  power(kPzt) = dielectric;
  power(kBoard) = parameters_.electronics_power;
  return power;
}

HeatLoss ThermalNetwork::heat_loss(
    double housing_temperature, const ThermalSurroundings& surroundings) const {
  const double T = housing_temperature, Ta = surroundings.ambient;
  const double excess = T - Ta;
  return {
      .natural_convection =
          natural_coefficient_ * fourth_root(std::abs(excess)) * excess,
      // Factored: the difference of fourth powers loses digits near ambient.
      .radiation =
          radiation_coefficient_ * (T * T + Ta * Ta) * (T + Ta) * excess,
      .forced_convection =
          surroundings.stirred ? forced_conductance_ * excess : 0.0,
      .fixture = parameters_.housing_fixture_conductance * excess};
}

NodeVector ThermalNetwork::heating_rate(
    const NodeVector& temperature, const NodeVector& power,
    const ThermalSurroundings& surroundings) const {
  NodeVector heat = power - conductance_ * temperature;
  heat(kHousing) -= heat_loss(temperature(kHousing), surroundings).total();
  return heat.cwiseQuotient(heat_capacity_);
}

NodeMatrix ThermalNetwork::heating_rate_jacobian(
    const NodeVector& temperature,
    const ThermalSurroundings& surroundings) const {
  const double T = temperature(kHousing);
  const double excess = std::abs(T - surroundings.ambient);
  NodeMatrix jacobian = -conductance_;
  jacobian(kHousing, kHousing) -=
      1.25 * natural_coefficient_ * fourth_root(excess) +
      4 * radiation_coefficient_ * T * T * T +
      (surroundings.stirred ? forced_conductance_ : 0.0) +
      parameters_.housing_fixture_conductance;
  return heat_capacity_.cwiseInverse().asDiagonal() * jacobian;
}

NodeVector ThermalNetwork::steady_state(
    const NodeVector& power, const ThermalSurroundings& surroundings) const {
  constexpr int kMaxIterations = 100;
  constexpr double kSmallestStep = 1e-10;  // [K]
  // Start away from ambient, where natural convection alone has no slope.
  NodeVector temperature = NodeVector::Constant(surroundings.ambient + 1.0);
  for (int i = 0; i < kMaxIterations; ++i) {
    const NodeVector step =
        solve_system(heating_rate_jacobian(temperature, surroundings),
                     heating_rate(temperature, power, surroundings));
    temperature -= step;
    if (step.cwiseAbs().maxCoeff() < kSmallestStep) return temperature;
  }
  throw SimulationFailure("thermal steady state: no convergence");
}

}  // namespace beamgyro::internal
