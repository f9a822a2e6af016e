// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sim/memory/unit_memory.h"
#include "sim/signal/readout.h"
#include "sim/stepper/loop_response.h"
#include "sim/stepper/settled_response.h"
#include "sim/stepper/step_inputs.h"
#include "sim/stepper/thermal_stepper.h"
#include "sim/stepper/tick_noise.h"

namespace beamgyro::internal {

inline constexpr double kLongestGyroStep = 1e5;  // [s]

/// One gyro that goes on step by step, without knowing what comes later: the
/// model of simulate_quasistatic() or simulate_envelope(). At the samples of a
/// scenario with straight lines it shows what the run shows, to the tolerances
/// of both. In the envelope it starts at rest, as a run does.
/// A copy is a snapshot. Use one object in one thread at a time.
class GyroStepper {
 public:
  /// Starts settled on the inputs of `start`. Throws std::invalid_argument for
  /// a number of `start` that is out of range and for the envelope of a unit
  /// with memory, and SimulationFailure where the gyro cannot work.
  GyroStepper(std::shared_ptr<const StepperModel> model,
              const StepperStart& start);

  /// The sample at the end of the last step, or at the start. Where the rate of
  /// the noise is that of the first step, the sample at the start has none.
  const StepSample& now() const { return sample_; }

  /// Advances by `duration` [s] while the inputs go from `from` to `to` along
  /// straight lines, with the power on or off; an input whose value before
  /// differs from `from` jumps. Returns the sample at the end, from before any
  /// jump there. Throws std::invalid_argument for a duration that is not above
  /// 0 or above kLongestGyroStep, and for inputs out of range,
  /// SimulationFailure as SettledResponse and check_materials(). After an
  /// exception everything is as it was.
  const StepSample& step(double duration, const StepInputs& from,
                         const StepInputs& to, bool powered);

  /// The same with held inputs.
  const StepSample& step(double duration, const StepInputs& held,
                         bool powered) {
    return step(duration, held, held, powered);
  }

  /// step() in two parts, for steps of several gyros that all succeed or none:
  /// prepare() throws as step() and changes nothing, and commit() makes the
  /// prepared step.
  void prepare(double duration, const StepInputs& from, const StepInputs& to,
               bool powered);
  const StepSample& commit();

  /// The inputs at the end of the last step.
  const StepInputs& inputs() const { return state_.inputs; }
  bool powered() const { return state_.powered; }
  double time() const { return state_.time(); }  // [s]

  /// Returns the state as bytes, for restore() in a stepper of the same model
  /// and start on such a machine.
  std::string state() const;
  /// Goes back to a state() of a stepper with the same model and start. Throws
  /// std::invalid_argument, and changes nothing, for other bytes.
  void restore(std::string_view bytes);

 private:
  struct PowerCycle {
    std::int64_t number = -1;          // from 0; -1: none yet
    double on = 0;                     // [s]
    double off = 0;                    // of the last cycle [s]
    double offset = 0, transient = 0;  // at power-on [rad/s]
  };
  struct State {
    // Equal steps are counted, so that their times do not drift.
    double start = 0, duration = 0;  // [s]
    std::int64_t steps = 0;
    ThermalStepper::State nodes;
    StepInputs inputs;
    bool powered;
    CaseFilter motion;
    std::optional<UnitMemory> memory = {};
    std::optional<LoopResponse::State> loops = {};  // in the envelope
    PowerCycle cycle = {};

    double time() const {
      return start + static_cast<double>(steps) * duration;
    }
    void pass(double step);
    void archive(StateArchive& archive);
  };
  // Of the loops, as their electronics measure them [Hz] [V] [rad/s].
  struct Channels {
    double drive_frequency, drive_voltage, quadrature;
  };

  State first_state() const;
  static MemoryState memory_of(const State& state);
  void switch_power(State& state, bool powered) const;
  void heat(State& state, double duration, const StepInputs& from,
            const StepInputs& to) const;
  void advance_loops(State& state, double duration, const StepInputs& from,
                     const StepInputs& to);
  StepSignals signals_of(const State& state);
  StepSignals loop_signals_of(const State& state);
  static NoiseConditions conditions_of(const State& state);
  double noise_of(const State& state) const;  // [rad/s]
  Channels channels_of(const State& state, const StepSignals& signals) const;
  void put_measured(const State& state, const StepSignals& signals,
                    StepSample& sample) const;
  void put_truth(const State& state, const StepSignals& signals,
                 StepSample& sample) const;
  StepSample sample_of(const State& state, const StepSignals& signals) const;

  std::shared_ptr<const StepperModel> model_;
  StepperStart start_;
  ThermalStepper thermal_;
  SettledResponse response_;
  std::optional<LoopResponse> loops_;  // in the envelope
  Readout readout_;
  std::optional<TickNoise> noise_;
  State state_, next_;
  StepSignals next_signals_{};
  StepSample sample_{};
};

}  // namespace beamgyro::internal
