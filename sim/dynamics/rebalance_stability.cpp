// SPDX-License-Identifier: MIT
#include "sim/dynamics/rebalance_stability.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "config/units.h"
#include "sim/dynamics/loop_noise.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {

void RebalanceStability::check(double t, double beam, double board) {
  if (std::abs(beam - beam_) <= kNoiseRefresh &&
      std::abs(board - board_) <= kNoiseRefresh)
    return;
  beam_ = beam, board_ = board;
  const double growth = growth_rate(loop_noise(gyro_, ode_, beam, board));
  if (growth < 0) return;
  throw SimulationFailure(fmt::format(
      "readout.mode = \"force_rebalance\": the loop of this device is unstable "
      "at {:g} s, with the beam at {:.2f} degC: a disturbance grows by e in "
      "{:.2g} s, because the gains are set at {:g} degC; expected more loss "
      "(patches.mechanical_loss_factor) or a lower "
      "readout.rebalance_bandwidth_Hz",
      t, beam - kZeroCelsius, 1 / growth,
      kCalibrationTemperature - kZeroCelsius));
}

std::optional<RebalanceStability> rebalance_stability(const TrimmedGyro& gyro) {
  if (gyro.loop.mode != ReadoutMode::kForceRebalance) return {};
  return std::optional<RebalanceStability>(std::in_place, gyro);
}

}  // namespace beamgyro::internal
