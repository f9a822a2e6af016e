// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/dynamics/envelope.h"
#include "sim/dynamics/gyro.h"
#include "sim/dynamics/rebalance_stability.h"
#include "sim/numerics/ode.h"
#include "sim/scenario/material_limits.h"
#include "sim/scenario/motion.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// The envelope of one gyro in one scenario, integrated in order of time. It
/// starts at rest at time 0; the integrator restarts at every jump of an input.
///
/// Most runs use CVODE's BDF with stability-limit detection: the beat of the
/// two modes lies outside the stability region of orders 3 to 5 at small steps,
/// and order 2 alone takes five times the steps. Runs whose motion bends more
/// than 50 times a second on average use Dormand-Prince, which restarts at
/// every bend without losing its order.
class EnvelopeTrajectory {
 public:
  /// `at_rest` selects the twin, whose rate about z is zero. The scenario, gyro
  /// and motion must outlive the trajectory. `tolerance` is the local error of
  /// a step in the output [rad/s], other states in proportion.
  EnvelopeTrajectory(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                     const Motion& motion, bool at_rest,
                     const ModalMemory* memory = nullptr,
                     double tolerance = 1e-8);

  /// Returns the signals of the gyro at increasing `times` [s], which must
  /// follow those of the call before. Bias and motion are left empty. Throws as
  /// MaterialLimits, RebalanceStability and Cvode.
  RunSamples advance(std::span<const double> times);

  long steps() const { return integrator_->steps(); }
  long rhs_evaluations() const { return integrator_->rhs_evaluations(); }

 private:
  EnvelopeInputs inputs(double t) const;
  void begin(std::size_t piece);
  void advance_to(double t_end, StateSamples& sampler);
  void check(double t, const Eigen::VectorXd& y);

  const ScenarioPlan& scenario_;
  const TrimmedGyro& gyro_;
  const Motion& motion_;
  bool at_rest_;
  MaterialLimits limits_;
  EnvelopeOde ode_;
  std::optional<RebalanceStability> stability_;
  std::vector<Piece> pieces_;
  std::size_t piece_ = 0;
  // Inputs that are constant over the present piece.
  bool powered_ = false;
  LinearStretch ambient_{};  // [K]
  std::optional<MotionSegment> segment_;
  std::unique_ptr<Cvode> multistep_;  // one of the two
  std::unique_ptr<ExplicitRk> explicit_;
  OdeIntegrator* integrator_;  // that one
};

/// Envelope run (L2): integrates the amplitudes of both modes, the drive loop,
/// the rebalance loop, demodulators, output filter and thermal network
/// (EnvelopeOde). A twin at rate 0 gives `true_bias`. Noise, saturation and ADC
/// follow as in every run. At each power-on the gyro starts at rest. `on_block`
/// receives the recording block by block, so memory does not grow with the run.
/// Throws as MaterialLimits, RebalanceStability and the integrator.
void simulate_envelope(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                       const RunKey& key, const BlockSink& on_block);

}  // namespace beamgyro::internal
