// SPDX-License-Identifier: MIT
#include "sim/numerics/ode.h"

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/numerics/simulation_failure.h"
#include "sim/numerics/sundials_objects.h"

namespace beamgyro::internal {
namespace {

constexpr Eigen::Index kHighestOrder = 5;  // of BDF

struct FreeCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
struct FreeArkStep {
  void operator()(void* memory) const { ARKStepFree(&memory); }
};

Eigen::Map<const Eigen::VectorXd> state_of(N_Vector y, Eigen::Index size) {
  return {N_VGetArrayPointer(y), size};
}

}  // namespace

// The equation and its state. Integrators are created from the context, which
// must outlive them: they are members of derived types.
struct OdeIntegrator::Problem {
  OdeRhs rhs;
  double time;
  Eigen::VectorXd y;  // SUNDIALS reads and writes it through `nv_y`
  long rhs_evaluations = 0;
  CallErrors errors;
  OwnedContext context;
  OwnedVector nv_y;

  Problem(OdeRhs f, double t0, const Eigen::VectorXd& y0)
      : rhs(std::move(f)),
        time(t0),
        y(y0),
        context(make_context()),
        nv_y(make_vector(y, context.get())) {}
  virtual ~Problem() = default;

  virtual long steps() const = 0;

  void check(int flag, const char* call) { errors.check(flag, call); }

  static int call_rhs(double t, N_Vector y, N_Vector dydt, void* user) {
    Problem& self = *static_cast<Problem*>(user);
    return self.errors.guarded([&] {
      const Eigen::Index n = self.y.size();
      Eigen::Map<Eigen::VectorXd> rate(N_VGetArrayPointer(dydt), n);
      ++self.rhs_evaluations;
      self.rhs(t, state_of(y, n), rate);
      require_finite(rate.allFinite(), "right-hand side", t);
    });
  }
};

OdeIntegrator::OdeIntegrator(std::unique_ptr<Problem> problem)
    : problem_(std::move(problem)) {}
OdeIntegrator::~OdeIntegrator() = default;

double OdeIntegrator::time() const { return problem_->time; }
const Eigen::VectorXd& OdeIntegrator::state() const { return problem_->y; }
long OdeIntegrator::steps() const { return problem_->steps(); }
long OdeIntegrator::rhs_evaluations() const {
  return problem_->rhs_evaluations;
}

struct Cvode::Memory : Problem {
  OdeJacobian jacobian;
  long max_steps;
  Eigen::VectorXd derivative;  // as y, through `nv_derivative`
  OdeStep step;
  long step_count = 0;

  OwnedVector nv_derivative;
  OwnedMatrix matrix;
  OwnedSolver linear_solver;
  Owned<void*, FreeCvode> memory;

  Memory(OdeRhs f, double t0, const Eigen::VectorXd& y0,
         const CvodeOptions& options)
      : Problem(std::move(f), t0, y0),
        jacobian(options.jacobian),
        max_steps(options.max_steps_per_advance),
        derivative(y0.size()),
        step{t0, t0, t0, 0, 0, Eigen::MatrixXd(y0.size(), kHighestOrder + 1)},
        nv_derivative(make_vector(derivative, context.get())),
        matrix(make_dense_matrix(y.size(), context.get())),
        linear_solver(make_dense_solver(y.size(), context.get())),
        memory(CVodeCreate(CV_BDF, context.get())) {
    if (!memory) throw std::runtime_error("CVodeCreate failed");
    configure(options);
  }

  long steps() const override { return step_count; }

  void configure(const CvodeOptions& options) {
    void* mem = memory.get();
    check(CVodeSetErrHandlerFn(mem, &CallErrors::on_error, &errors),
          "CVodeSetErrHandlerFn");
    check(CVodeInit(mem, &Problem::call_rhs, time, nv_y.get()), "CVodeInit");
    check(CVodeSetUserData(mem, static_cast<Problem*>(this)),
          "CVodeSetUserData");
    set_tolerances(options);
    check(CVodeSetLinearSolver(mem, linear_solver.get(), matrix.get()),
          "CVodeSetLinearSolver");
    if (jacobian) {
      check(CVodeSetJacFn(mem, &Memory::call_jacobian), "CVodeSetJacFn");
    }
    if (options.stability_limit_detection) {
      check(CVodeSetStabLimDet(mem, SUNTRUE), "CVodeSetStabLimDet");
    }
  }

  void set_tolerances(const CvodeOptions& options) {
    Eigen::VectorXd absolute = full_tolerances(
        options.relative_tolerance, options.absolute_tolerance, y.size());
    const OwnedVector nv_absolute = make_vector(absolute, context.get());
    check(CVodeSVtolerances(memory.get(), options.relative_tolerance,
                            nv_absolute.get()),
          "CVodeSVtolerances");
  }

  void take_step(double t_end) {
    void* mem = memory.get();
    step.begin = time;
    check(CVode(mem, t_end, nv_y.get(), &time, CV_ONE_STEP), "CVode");
    step.end = time;
    ++step_count;
  }

  // Scaled derivatives at the end of the step: CVODE's own interpolant as
  // coefficients, so that a sample costs one Horner scheme and no call.
  void fill_interpolant() {
    void* mem = memory.get();
    int order = 0;
    check(CVodeGetLastOrder(mem, &order), "CVodeGetLastOrder");
    check(CVodeGetLastStep(mem, &step.size), "CVodeGetLastStep");
    check(CVodeGetCurrentTime(mem, &step.centre), "CVodeGetCurrentTime");
    step.order = order;
    double scale = 1;  // size^k / k!
    for (int k = 0; k <= order; ++k) {
      check(CVodeGetDky(mem, step.centre, k, nv_derivative.get()),
            "CVodeGetDky");
      step.coefficients.col(k) = scale * derivative;
      scale *= step.size / (k + 1);
    }
  }

  static int call_jacobian(double t, N_Vector y, N_Vector, SUNMatrix df_dy,
                           void* user, N_Vector, N_Vector, N_Vector) {
    Memory& self = static_cast<Memory&>(*static_cast<Problem*>(user));
    return self.errors.guarded([&] {
      const Eigen::Index n = self.y.size();
      Eigen::Map<Eigen::MatrixXd> slope(SUNDenseMatrix_Data(df_dy), n, n);
      self.jacobian(t, state_of(y, n), slope);
      require_finite(slope.allFinite(), "Jacobian", t);
    });
  }
};

Eigen::VectorXd OdeStep::at(double t) const {
  const double s = (t - centre) / size;
  Eigen::VectorXd y = coefficients.col(order);
  for (Eigen::Index k = order - 1; k >= 0; --k) y = y * s + coefficients.col(k);
  return y;
}

void sample_polynomial(std::span<const double> coefficients, double centre,
                       double size, std::span<const double> times,
                       std::span<double> values) {
  assert(times.size() == values.size());
  // Blocks small enough for the first cache keep every Horner pass in it.
  constexpr Eigen::Index kBlock = 256;
  using Block = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1>;
  const auto count = static_cast<Eigen::Index>(times.size());
  for (Eigen::Index first = 0; first < count; first += kBlock) {
    const Eigen::Index n = std::min(kBlock, count - first);
    const Block s =
        (Eigen::Map<const Eigen::ArrayXd>(times.data() + first, n) - centre) *
        (1 / size);
    Block y = Block::Constant(n, coefficients.back());
    for (std::size_t k = coefficients.size() - 1; k-- > 0;)
      y = y * s + coefficients[k];
    Eigen::Map<Eigen::ArrayXd>(values.data() + first, n) = y;
  }
}

void OdeStep::sample(Eigen::Index component, std::span<const double> times,
                     std::span<double> values) const {
  std::array<double, kHighestOrder + 1> terms{};
  const auto count = static_cast<std::size_t>(order) + 1;
  for (std::size_t k = 0; k < count; ++k)
    terms[k] = coefficients(component, static_cast<Eigen::Index>(k));
  sample_polynomial(std::span(terms).first(count), centre, size, times, values);
}

StateSamples::StateSamples(std::span<const double> times,
                           std::vector<Eigen::Index> components)
    : times_(times),
      components_(std::move(components)),
      columns_(components_.size(), std::vector<double>(times.size())) {}

void StateSamples::take(const OdeStep& step) {
  const auto begin = times_.begin() + static_cast<std::ptrdiff_t>(next_);
  const auto count = static_cast<std::size_t>(
      std::lower_bound(begin, times_.end(), step.end) - begin);
  for (std::size_t i = 0; i < columns_.size() && count > 0; ++i) {
    step.sample(components_[i], times_.subspan(next_, count),
                std::span(columns_[i]).subspan(next_, count));
  }
  next_ += count;
}

void StateSamples::take_until(double t, const Eigen::VectorXd& y) {
  for (; next_ < times_.size() && times_[next_] <= t; ++next_)
    for (std::size_t i = 0; i < columns_.size(); ++i)
      columns_[i][next_] = y(components_[i]);
}

Cvode::Cvode(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
             const CvodeOptions& options)
    : OdeIntegrator(std::make_unique<Memory>(std::move(rhs), t0, y0, options)) {
}

Cvode::Memory& Cvode::memory() { return static_cast<Memory&>(*problem_); }

const Eigen::VectorXd& Cvode::advance_to(
    double t_end, const std::function<void(const OdeStep&)>& on_step) {
  Memory& m = memory();
  if (t_end == m.time) return m.y;
  m.check(CVodeSetStopTime(m.memory.get(), t_end), "CVodeSetStopTime");
  const long last = m.step_count + m.max_steps;
  while (m.time != t_end) {
    if (m.step_count >= last) {
      throw SimulationFailure("no arrival at t = " + std::to_string(t_end) +
                              " s within " + std::to_string(m.max_steps) +
                              " steps; reached " + std::to_string(m.time) +
                              " s");
    }
    m.take_step(t_end);
    if (on_step) {
      m.fill_interpolant();
      on_step(m.step);
    }
  }
  return m.y;
}

void Cvode::restart(double t, const Eigen::VectorXd& y) {
  Memory& m = memory();
  m.time = t;
  m.y = y;
  m.check(CVodeReInit(m.memory.get(), t, m.nv_y.get()), "CVodeReInit");
}

struct ExplicitRk::Memory : Problem {
  Owned<void*, FreeArkStep> memory;

  Memory(OdeRhs f, double t0, const Eigen::VectorXd& y0,
         const ExplicitRkOptions& options)
      : Problem(std::move(f), t0, y0),
        memory(ARKStepCreate(&Problem::call_rhs, nullptr, t0, nv_y.get(),
                             context.get())) {
    if (!memory) throw std::runtime_error("ARKStepCreate failed");
    configure(options);
  }

  long steps() const override {
    long count = 0;
    ARKStepGetNumSteps(memory.get(), &count);
    return count;
  }

  void configure(const ExplicitRkOptions& options) {
    void* mem = memory.get();
    Eigen::VectorXd absolute = full_tolerances(
        options.relative_tolerance, options.absolute_tolerance, y.size());
    const OwnedVector nv_absolute = make_vector(absolute, context.get());
    check(ARKStepSetErrHandlerFn(mem, &CallErrors::on_error, &errors),
          "ARKStepSetErrHandlerFn");
    check(ARKStepSetUserData(mem, static_cast<Problem*>(this)),
          "ARKStepSetUserData");
    check(
        ARKStepSVtolerances(mem, options.relative_tolerance, nv_absolute.get()),
        "ARKStepSVtolerances");
    const ARKODE_ERKTableID table = options.table == RkTable::kFehlberg
                                        ? ARKODE_FEHLBERG_13_7_8
                                        : ARKODE_DORMAND_PRINCE_7_4_5;
    check(ARKStepSetTableNum(mem, ARKODE_DIRK_NONE, table),
          "ARKStepSetTableNum");
    check(ARKStepSetMaxNumSteps(mem, options.max_steps_per_advance),
          "ARKStepSetMaxNumSteps");
    if (options.fixed_step > 0) {
      check(ARKStepSetFixedStep(mem, options.fixed_step),
            "ARKStepSetFixedStep");
    }
  }
};

ExplicitRk::ExplicitRk(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
                       const ExplicitRkOptions& options)
    : OdeIntegrator(std::make_unique<Memory>(std::move(rhs), t0, y0, options)) {
}

ExplicitRk::Memory& ExplicitRk::memory() {
  return static_cast<Memory&>(*problem_);
}

const Eigen::VectorXd& ExplicitRk::advance_to(double t_end) {
  Memory& m = memory();
  if (t_end == m.time) return m.y;
  void* mem = m.memory.get();
  m.check(ARKStepSetStopTime(mem, t_end), "ARKStepSetStopTime");
  m.check(ARKStepEvolve(mem, t_end, m.nv_y.get(), &m.time, ARK_NORMAL),
          "ARKStepEvolve");
  return m.y;
}

void ExplicitRk::restart(double t, const Eigen::VectorXd& y) {
  Memory& m = memory();
  m.time = t;
  m.y = y;
  m.check(ARKStepReset(m.memory.get(), t, m.nv_y.get()), "ARKStepReset");
}

void ExplicitRk::restart(double t, const Eigen::VectorXd& y, double step) {
  Memory& m = memory();
  m.time = t;
  m.y = y;
  void* mem = m.memory.get();
  m.check(ARKStepReInit(mem, &Problem::call_rhs, nullptr, t, m.nv_y.get()),
          "ARKStepReInit");
  m.check(ARKStepSetInitStep(mem, step), "ARKStepSetInitStep");
}

double ExplicitRk::next_step() {
  double step = 0;
  memory().check(ARKStepGetCurrentStep(memory().memory.get(), &step),
                 "ARKStepGetCurrentStep");
  return step;
}

}  // namespace beamgyro::internal
