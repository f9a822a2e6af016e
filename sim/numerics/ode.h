// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>

namespace beamgyro::internal {

/// dy/dt = f(t, y); must fill every entry of `dydt`. May throw.
using OdeRhs =
    std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& y,
                       Eigen::Ref<Eigen::VectorXd> dydt)>;

/// J(i, j) = df_i/dy_j; must fill every entry of `df_dy`. May throw.
using OdeJacobian =
    std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& y,
                       Eigen::Ref<Eigen::MatrixXd> df_dy)>;

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

/// What both integrators have in common. Each object owns its SUNDIALS context,
/// so different objects may be used in different threads. No SUNDIALS type
/// leaves ode.cpp.
class OdeIntegrator {
 public:
  virtual ~OdeIntegrator();

  double time() const;
  const Eigen::VectorXd& state() const;
  long steps() const;            // since construction, restarts included
  long rhs_evaluations() const;  // likewise

  /// Continues from another time or state; call after a jump in the right-hand
  /// side.
  virtual void restart(double t, const Eigen::VectorXd& y) = 0;

 protected:
  struct Problem;
  explicit OdeIntegrator(std::unique_ptr<Problem> problem);

  std::unique_ptr<Problem> problem_;  // SUNDIALS keeps a pointer to it
};

/// Adaptive multistep integrator (SUNDIALS CVODE, BDF, modified Newton on a
/// dense Jacobian).
class Cvode : public OdeIntegrator {
 public:
  /// Throws std::invalid_argument for tolerances that do not fit `y0`.
  Cvode(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
        const CvodeOptions& options = {});

  /// Integrates to exactly `t_end` >= time() and returns y there. Neither the
  /// right-hand side nor the Jacobian is evaluated beyond `t_end`, so there may
  /// be a discontinuity. `on_step` is called for every internal step; the steps
  /// join without a gap and the last ends at `t_end`.
  /// - Rethrows what a callback threw.
  /// - Throws SimulationFailure for a right-hand side that is not finite and
  ///   when CVODE gives up.
  const Eigen::VectorXd& advance_to(
      double t_end, const std::function<void(const OdeStep&)>& on_step = {});

  /// Discards the step history.
  void restart(double t, const Eigen::VectorXd& y) override;

 private:
  struct Memory;
  Memory& memory();
};

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
/// end of the step for first-same-as-last ones.
class ExplicitRk : public OdeIntegrator {
 public:
  /// Throws std::invalid_argument for tolerances that do not fit `y0`.
  ExplicitRk(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
             const ExplicitRkOptions& options = {});

  /// Integrates to exactly `t_end` >= time() and returns y there. The
  /// right-hand side is not evaluated beyond `t_end`. Rethrows what the
  /// right-hand side threw. Throws SimulationFailure when it is not finite and
  /// when ARKODE gives up.
  const Eigen::VectorXd& advance_to(double t_end);

  /// Keeps the step size.
  void restart(double t, const Eigen::VectorXd& y) override;

  /// Forgets everything before, and tries `step` [s] first; 0: what it finds.
  /// What follows depends on t, y and step alone.
  void restart(double t, const Eigen::VectorXd& y, double step);
  /// Returns the step that would be tried next [s].
  double next_step();

 private:
  struct Memory;
  Memory& memory();
};

}  // namespace beamgyro::internal
