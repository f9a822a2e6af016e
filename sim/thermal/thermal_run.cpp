// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/thermal/thermal_ode.h"

namespace beamgyro::internal {
namespace {

[[noreturn]] void reject(const std::string& message) {
  throw std::invalid_argument("thermal run: " + message);
}

void require_valid_run(const ThermalLoad& load) {
  double last = -std::numeric_limits<double>::infinity();
  for (const PowerInterval& interval : load.powered) {
    if (!(interval.on >= last && interval.off > interval.on)) {
      reject(
          fmt::format("power on at {} s and off at {} s after {} s; times "
                      "must increase",
                      interval.on, interval.off, last));
    }
    last = interval.off;
  }
  if (!(load.mechanical_power >= 0 && load.dielectric_power >= 0)) {
    reject(fmt::format("heating powers {} W and {} W must be >= 0",
                       load.mechanical_power, load.dielectric_power));
  }
}

void require_increasing(std::span<const double> times) {
  double before = -1;
  for (const double t : times) {
    if (!(std::isfinite(t) && t >= 0)) {
      reject(fmt::format("time {} s must be finite and >= 0", t));
    }
    if (t <= before) {
      reject(fmt::format("time {} s does not come after {} s", t, before));
    }
    before = t;
  }
}

std::vector<Border> borders_of(const ThermalLoad& load) {
  std::vector<Border> borders = load.ambient.borders();
  for (const PowerInterval& interval : load.powered)
    borders.insert(borders.end(), {{interval.on, true}, {interval.off, true}});
  return borders;
}

std::vector<double> heater_power(const ThermalOven& oven,
                                 const ThermalLoad& load,
                                 std::span<const double> times,
                                 const std::vector<double>& mount,
                                 const std::vector<double>& integral) {
  std::vector<double> power(times.size(), 0.0);
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (powered_at(load.powered, times[k])) {
      power[k] = oven_action(oven, mount[k], integral[k]).power;
    }
  }
  return power;
}

}  // namespace

bool powered_at(std::span<const PowerInterval> powered, double t) {
  return std::any_of(powered.begin(), powered.end(),
                     [t](const PowerInterval& interval) {
                       return interval.on <= t && t < interval.off;
                     });
}

void integrate_temperatures(const ThermalNetwork& network,
                            const ThermalLoad& load, double end,
                            const ThermalSink& sink, double tolerance) {
  require_valid_run(load);
  const ThermalOde ode(network, load.mechanical_power, load.dielectric_power);
  const Eigen::Index size = ode.size();
  LinearStretch ambient{};
  bool powered = false;
  const auto surroundings = [&](double t) -> ThermalSurroundings {
    return {ambient.at(t), load.stirred};
  };
  Eigen::VectorXd y = Eigen::VectorXd::Constant(size, load.ambient.value(0));
  y.tail(size - kThermalNodeCount).setZero();

  CvodeOptions options;
  options.relative_tolerance = 0;
  options.absolute_tolerance = Eigen::VectorXd::Constant(1, tolerance);
  options.jacobian = [&](double t, const auto& state, auto slope) {
    ode.jacobian(surroundings(t), powered, state, slope);
  };
  Cvode cvode(
      [&](double t, const auto& state, auto rate) {
        ode.rate(surroundings(t), powered, state, rate);
      },
      0.0, y, options);
  for (const Piece& piece : pieces_until(end, borders_of(load))) {
    const bool was_powered = powered;
    powered = powered_at(load.powered, piece.start);
    if (powered && !was_powered) y.tail(size - kThermalNodeCount).setZero();
    ambient = load.ambient.stretch(piece.start, piece.end);
    sink.on_state(piece.start, y);
    cvode.restart(piece.start, y);
    y = cvode.advance_to(piece.end, sink.on_step);
  }
  sink.on_state(end, y);
}

ThermalHistory simulate_temperatures(const ThermalNetwork& network,
                                     const ThermalLoad& load,
                                     std::span<const double> times,
                                     double tolerance) {
  require_increasing(times);
  ThermalHistory history;
  if (times.empty()) return history;
  std::vector<Eigen::Index> components(
      static_cast<std::size_t>(ThermalOde(network, 0, 0).size()));
  std::iota(components.begin(), components.end(), 0);
  StateSamples samples(times, components);
  integrate_temperatures(
      network, load, times.back(),
      {.on_state = [&](double t, const auto& y) { samples.take_until(t, y); },
       .on_step = [&](const OdeStep& step) { samples.take(step); }},
      tolerance);
  if (network.parameters().oven) {
    history.heater_power =
        heater_power(*network.parameters().oven, load, times,
                     samples.columns()[kMount], samples.columns().back());
  }
  for (std::size_t i = 0; i < kThermalNodeCount; ++i)
    history.temperature[i] = std::move(samples.columns()[i]);
  return history;
}

}  // namespace beamgyro::internal
