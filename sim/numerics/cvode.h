// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>

#include "sim/numerics/ode.h"

namespace beamgyro::internal {

struct CvodeOptions {
  double relative_tolerance = 1e-8;
  /// In the unit of y: one entry for each component, or one for all.
  Eigen::VectorXd absolute_tolerance = Eigen::VectorXd::Constant(1, 1e-10);
  OdeJacobian jacobian = {};  // empty: difference quotients
  /// Lower the order where an eigenvalue near the imaginary axis lies
  /// outside the stability region of orders 3 to 5.
  bool stability_limit_detection = false;
  long max_steps_per_advance = 1000000;
};

struct CvodeStatistics {  // since construction, restarts included
  long steps = 0;
  long rhs_evaluations = 0;
};

/// values[j] = sum_k c_k s^k, s = (times[j] - centre) / size; both spans are
/// equally long.
void sample_polynomial(std::span<const double> coefficients, double centre,
                       double size, std::span<const double> times,
                       std::span<double> values);

/// One internal step and its interpolant, which has the order of the step:
///   y(t) = sum_k c_k s^k,  s = (t - centre) / size,  begin <= t <= end.
struct OdeStep {
  double begin, end;             // [s]
  double centre, size;           // [s]
  Eigen::Index order;            // highest power
  Eigen::MatrixXd coefficients;  // c(i, k), columns 0 .. order

  Eigen::VectorXd at(double t) const;

  /// values[j] = y_component(times[j]); both spans are equally long.
  void sample(Eigen::Index component, std::span<const double> times,
              std::span<double> values) const;
};

/// Components of the state at increasing times [s], filled in order of time.
class StateSamples {
 public:
  /// `times` must outlive the object.
  StateSamples(std::span<const double> times,
               std::vector<Eigen::Index> components);

  double next_time() const { return times_[next_]; }
  bool complete() const { return next_ == times_.size(); }
  /// Takes a step without its end: an input may jump there.
  void take(const OdeStep& step);
  /// Takes the state `y` at `t` [s] and at all times before it that are left.
  void take_until(double t, const Eigen::VectorXd& y);
  /// By component, one value for each time.
  std::vector<std::vector<double>>& columns() { return columns_; }

 private:
  std::span<const double> times_;
  std::vector<Eigen::Index> components_;
  std::vector<std::vector<double>> columns_;
  std::size_t next_ = 0;
};

/// Adaptive multistep integrator (SUNDIALS CVODE, BDF, modified Newton on a
/// dense Jacobian). Each object owns its SUNDIALS context, so different objects
/// may be used in different threads. No SUNDIALS type leaves cvode.cpp.
class Cvode {
 public:
  /// Throws std::invalid_argument for tolerances that do not fit `y0`.
  Cvode(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
        const CvodeOptions& options = {});
  ~Cvode();

  /// Integrates to exactly `t_end` >= time() and returns y there. Neither the
  /// right-hand side nor the Jacobian is evaluated beyond `t_end`, so there may
  /// be a discontinuity. `on_step` is called for every internal step; the steps
  /// join without a gap and the last ends at `t_end`.
  /// - Rethrows what a callback threw.
  /// - Throws SimulationFailure for a right-hand side that is not finite and
  ///   when CVODE gives up.
  const Eigen::VectorXd& advance_to(
      double t_end, const std::function<void(const OdeStep&)>& on_step = {});

  /// Discards the step history; call after a jump in the right-hand side.
  void restart(double t, const Eigen::VectorXd& y);

  double time() const;
  const Eigen::VectorXd& state() const;
  const CvodeStatistics& statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;  // stable address: CVODE keeps a pointer to it
};

}  // namespace beamgyro::internal
