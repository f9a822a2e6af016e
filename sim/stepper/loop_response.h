// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "sim/dynamics/envelope.h"
#include "sim/dynamics/motion_segment.h"
#include "sim/dynamics/rebalance_stability.h"
#include "sim/numerics/ode.h"
#include "sim/numerics/state_archive.h"
#include "sim/stepper/settled_response.h"

namespace beamgyro::internal {

/// What acts on a gyro over one step: straight lines.
struct StepCourse {
  double start, duration;  // [s]
  StepInputs from, to;
  bool powered, stirred;
};

/// The envelope of one gyro (EnvelopeOde) step by step, by Dormand-Prince. A
/// twin at rate 0 gives the bias; it goes its own way from the first rate that
/// is not 0. Units with memory have none. Use one object in one thread at a
/// time.
class LoopResponse {
 public:
  struct State {
    Eigen::VectorXd y;  // of EnvelopeOde
    double step = 0;    // that the integrator tries next [s]; 0: any
    bool has_twin = false;
    Eigen::VectorXd twin = {};  // the same at rate 0
    double twin_step = 0;

    void archive(StateArchive& archive);
  };

  explicit LoopResponse(std::shared_ptr<const StepperModel> model);
  // What it refers to stays with the model.
  LoopResponse(const LoopResponse& other) : LoopResponse(other.model_) {}
  LoopResponse& operator=(const LoopResponse&) = delete;

  /// The beam at rest, the nodes at `nodes` [K].
  State at_rest(const NodeVector& nodes) const;

  /// Stops vibration and loops, as they do within a second without power.
  void stop(State& state) const;

  /// Throws as ExplicitRk.
  void advance(State& state, const StepCourse& course);

  static NodeVector nodes(const State& state);

  /// The signals at `t` [s], without `spurious_bias`. Throws as
  /// RebalanceStability for a powered gyro.
  StepSignals at(double t, const State& state, bool powered);

 private:
  void advance(Eigen::VectorXd& y, double& step, const StepCourse& course,
               bool at_rest);

  std::shared_ptr<const StepperModel> model_;
  EnvelopeOde ode_;
  std::optional<RebalanceStability> stability_;
  // Inputs of the present step.
  std::optional<MotionSegment> segment_;
  StepCourse course_{};
  bool at_rest_ = false;
  ExplicitRk integrator_;
};

}  // namespace beamgyro::internal
