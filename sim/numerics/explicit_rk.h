// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>

#include "sim/numerics/ode.h"

namespace beamgyro::internal {

enum class RkTable {
  kDormandPrince,  // 7 stages, order 5
  kFehlberg,       // 13 stages, order 8
};

struct ExplicitRkOptions {
  RkTable table = RkTable::kFehlberg;
  double relative_tolerance = 0;
  /// In the unit of y: one entry for each component, or one for all.
  Eigen::VectorXd absolute_tolerance = Eigen::VectorXd::Constant(1, 1e-9);
  double fixed_step = 0;  // [s]; 0: steps follow the tolerances
  long max_steps_per_advance = 100'000'000;
};

/// Explicit Runge-Kutta integrator (SUNDIALS ARKODE's ARKStep). ERKStep of
/// SUNDIALS 6.4 must not be used: it takes tables whose last stage lies at the
/// end of the step for first-same-as-last ones. Each object owns its SUNDIALS
/// context. No SUNDIALS type leaves explicit_rk.cpp.
class ExplicitRk {
 public:
  /// Throws std::invalid_argument for tolerances that do not fit `y0`.
  ExplicitRk(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
             const ExplicitRkOptions& options = {});
  ~ExplicitRk();

  /// Integrates to exactly `t_end` >= time() and returns y there. The
  /// right-hand side is not evaluated beyond `t_end`. Rethrows what the
  /// right-hand side threw. Throws SimulationFailure when it is not finite and
  /// when ARKODE gives up.
  const Eigen::VectorXd& advance_to(double t_end);

  /// Continues from another time or state, with the same step size.
  void restart(double t, const Eigen::VectorXd& y);

  double time() const;
  const Eigen::VectorXd& state() const;
  long steps() const;            // since construction
  long rhs_evaluations() const;  // since construction

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;  // stable address: ARKODE keeps a pointer to it
};

}  // namespace beamgyro::internal
