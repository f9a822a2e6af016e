// SPDX-License-Identifier: MIT
#include "planning/chamber_view.h"

#include <stdexcept>

#include "config/units.h"

namespace beamgyro::internal {

ChamberView::ChamberView(const ThermalParameters& parameters, double offset)
    : network_(parameters), offset_(offset) {
  if (parameters.oven)
    throw std::invalid_argument(
        "the device has an oven, which holds the beam at one temperature "
        "whatever the chamber does; expected a device without");
}

NodeVector ChamberView::settled(double chamber) const {
  const ThermalSurroundings air{chamber + kZeroCelsius, true};
  return network_.steady_state(network_.powered_heating(0.0, 0.0), air);
}

double ChamberView::sensor_temperature(double chamber) const {
  return settled(chamber)(kSensor) - kZeroCelsius + offset_;
}

Eigen::ArrayXd ChamberView::sensor_temperatures(
    const Eigen::ArrayXd& chamber) const {
  Eigen::ArrayXd sensor(chamber.size());
  for (Eigen::Index k = 0; k < chamber.size(); ++k)
    sensor(k) = sensor_temperature(chamber(k));
  return sensor;
}

double ChamberView::chamber_temperature(double sensor) const {
  // The excess hardly depends on the temperature: a few rounds converge.
  double chamber = sensor;
  for (int round = 0; round < 8; ++round)
    chamber += sensor - sensor_temperature(chamber);
  return chamber;
}

double ChamberView::beam_excess(double chamber) const {
  const NodeVector T = settled(chamber);
  return T(kBeam) - T(kSensor);
}

}  // namespace beamgyro::internal
