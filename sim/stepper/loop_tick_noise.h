// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "sim/dynamics/envelope.h"
#include "sim/signal/linear_noise.h"
#include "sim/stepper/step_inputs.h"
#include "sim/stepper/stepper_model.h"

namespace beamgyro::internal {

/// Noise of mechanics and charge amplifiers behind loops and filters
/// (loop_noise()), at the ticks of a gyro that is stepped. The coefficients
/// follow the temperatures in steps of kNoiseRefresh. Without power the state
/// does not advance.
class LoopTickNoise {
 public:
  /// `rate` [Hz] is that of the ticks.
  LoopTickNoise(std::shared_ptr<const StepperModel> model,
                const StepperStart& start, double rate);

  /// Goes on by `ticks` with beam and board at these temperatures [K]. The
  /// first one of a powered gyro makes a stationary state. Throws as
  /// loop_noise().
  void advance(std::uint64_t ticks, double beam, double board);

  /// Takes the last tick back: the power went off at its time.
  void undo();

  double output() const;      // [rad/s]
  double quadrature() const;  // [rad/s]
  /// Of drive frequency [Hz] and voltage [V].
  Eigen::Vector2d drive() const;

  void archive(StateArchive& archive);

 private:
  NoiseSystem system(double beam, double board);
  void begin(double beam, double board);

  std::shared_ptr<const StepperModel> model_;
  EnvelopeOde ode_;
  Eigen::Matrix2Xd channels_;
  double interval_;      // [s]
  RandomStream stream_;  // at its start
  std::optional<LinearNoise> noise_;
  bool is_first_ = false;        // the tick of noise_ is its first
  double beam_ = 0, board_ = 0;  // of the coefficients [K]
};

}  // namespace beamgyro::internal
