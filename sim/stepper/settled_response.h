// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "sim/dynamics/rebalance_stability.h"
#include "sim/dynamics/spurious_bias.h"
#include "sim/stepper/case_filter.h"
#include "sim/stepper/stepper_model.h"

namespace beamgyro::internal {

/// What beam and loops show at one moment, before noise and readout.
struct StepSignals {
  double output, quadrature;  // rate-equivalent [rad/s]
  double bias;                // output of the twin at rate 0 [rad/s]
  double spurious_bias = 0;   // its part by spurious modes [rad/s]
  double drive_frequency;     // [Hz]
  double drive_voltage;       // [V]
  bool locked;
};

/// The static response (2.10) of one gyro at one moment after the other. It
/// remembers nothing that its answers depend on. Use one object in one thread
/// at a time.
class SettledResponse {
 public:
  explicit SettledResponse(std::shared_ptr<const StepperModel> model);
  // What it refers to stays with the model.
  SettledResponse(const SettledResponse& other)
      : SettledResponse(other.model_) {}
  SettledResponse& operator=(const SettledResponse&) = delete;

  /// The response with the nodes at `nodes` [K]. Throws SimulationFailure where
  /// the drive loop cannot lock, and where a rebalance loop of a powered gyro
  /// is unstable; `t` [s] is in its message.
  StepSignals at(double t, const NodeVector& nodes, const MemoryState& memory,
                 const CaseFilter& motion, bool powered);

 private:
  StepSignals from_map(const NodeVector& nodes, double rate,
                       const Electronics& board) const;
  StepSignals exact(const NodeVector& nodes, const MemoryState& memory,
                    const CaseFilter& motion, const Electronics& board);

  std::shared_ptr<const StepperModel> model_;
  LockPath path_;
  std::optional<SpuriousBias> spurious_;
  std::optional<RebalanceStability> stability_;
};

}  // namespace beamgyro::internal
