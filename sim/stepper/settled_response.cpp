// SPDX-License-Identifier: MIT
#include "sim/stepper/settled_response.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

StepSignals signals_of(const Electronics& board, const BeamSignal& at_rate,
                       const Complex& at_rest) {
  const Output shown = board.output(at_rate.demodulated);
  return {.output = shown.rate,
          .quadrature = shown.quadrature,
          .bias = at_rate.demodulated == at_rest ? shown.rate
                                                 : board.output(at_rest).rate,
          .drive_frequency = at_rate.drive_frequency / (2 * std::numbers::pi),
          .drive_voltage = at_rate.drive_voltage,
          .locked = at_rate.amplitude_locked};
}

}  // namespace

SettledResponse::SettledResponse(std::shared_ptr<const StepperModel> model)
    : model_(std::move(model)), stability_(rebalance_stability(model_->gyro)) {
  if (!model_->gyro.device.spurious_modes.empty())
    spurious_.emplace(model_->gyro);
}

StepSignals SettledResponse::at(double t, const NodeVector& nodes,
                                const MemoryState& memory,
                                const CaseFilter& motion, bool powered) {
  const Electronics board = electronics_at(model_->gyro, nodes(kBoard));
  const double T = nodes(kBeam);
  const bool is_in_map =
      model_->map && T >= model_->coldest && T <= model_->hottest &&
      std::abs(motion.rate_z()) <= model_->fastest && motion.is_rate_z_alone();
  try {
    const StepSignals signals = is_in_map
                                    ? from_map(nodes, motion.rate_z(), board)
                                    : exact(nodes, memory, motion, board);
    if (stability_ && powered && signals.locked)
      stability_->check(t, T, nodes(kBoard));
    return signals;
  } catch (const SimulationFailure& error) {
    if (is_in_map) throw;
    throw SimulationFailure(
        fmt::format("at {:g} s, with the beam at {:.2f} degC: {}", t,
                    T - kZeroCelsius, error.what()));
  }
}

StepSignals SettledResponse::from_map(const NodeVector& nodes, double rate,
                                      const Electronics& board) const {
  const StaticMap::Signals beam = model_->map->at(nodes(kBeam), rate);
  StepSignals signals = signals_of(board, beam.at_rate, beam.at_rest);
  if (spurious_)
    signals.spurious_bias =
        spurious_->of(beam.at_rest, beam.without_spurious, board);
  return signals;
}

StepSignals SettledResponse::exact(const NodeVector& nodes,
                                   const MemoryState& memory,
                                   const CaseFilter& motion,
                                   const Electronics& board) {
  const TrimmedGyro& gyro = model_->gyro;
  const SpuriousTemperatures temperatures = {nodes(kBeam), nodes(kHousing)};
  const ModalParameters modal = modal_at(gyro, temperatures, memory);
  CaseMotion of_case = motion.motion(gyro.device.mount);
  const BeamSignal at_rate = beam_signal(gyro, modal, of_case, path_);
  Complex at_rest = at_rate.demodulated;
  if (of_case.z != 0) {
    of_case.z = 0;
    at_rest = beam_signal(gyro, modal, of_case, path_, at_rate.drive_frequency)
                  .demodulated;
  }
  StepSignals signals = signals_of(board, at_rate, at_rest);
  if (spurious_)
    signals.spurious_bias =
        spurious_->at(at_rest, temperatures, memory, of_case, board);
  return signals;
}

}  // namespace beamgyro::internal
