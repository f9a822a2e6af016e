// SPDX-License-Identifier: MIT
#include "planning/chamber.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "config/units.h"

namespace beamgyro::internal {

std::vector<double> in_visiting_order(std::vector<double> temperatures,
                                      double start) {
  std::ranges::sort(temperatures);
  if (!temperatures.empty() && std::abs(temperatures.back() - start) <
                                   std::abs(temperatures.front() - start))
    std::ranges::reverse(temperatures);
  return temperatures;
}

double shortest_way(const std::vector<double>& temperatures, double start) {
  if (temperatures.empty()) return 0.0;
  const auto [low, high] = std::ranges::minmax(temperatures);
  return high - low + std::min(std::abs(start - low), std::abs(start - high));
}

double chamber_hours(const std::vector<double>& temperatures,
                     const ChamberTime& time) {
  return shortest_way(temperatures, time.start) / time.ramp / 60.0 +
         static_cast<double>(temperatures.size()) * time.hold / 3600.0;
}

std::vector<Visit> visits(const std::vector<double>& temperatures,
                          const ChamberTime& time) {
  std::vector<Visit> found;
  double clock = 0.0, before = time.start;
  for (const double T : in_visiting_order(temperatures, time.start)) {
    clock += std::abs(T - before) / time.ramp * 60.0;
    found.push_back({T, clock, clock + time.hold});
    clock += time.hold;
    before = T;
  }
  return found;
}

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
