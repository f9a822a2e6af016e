// SPDX-License-Identifier: MIT
#include "sim/numerics/cvode.h"

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

}  // namespace

struct Cvode::Impl {
  OdeRhs rhs;
  OdeJacobian jacobian;
  long max_steps;
  double time;
  Eigen::VectorXd y;           // CVODE reads and writes it through `nv_y`
  Eigen::VectorXd derivative;  // the same through `nv_derivative`
  OdeStep step;
  CvodeStatistics statistics;
  CallErrors errors;

  // Destroyed bottom-up: the context must outlive everything created from it.
  OwnedContext context;
  OwnedVector nv_y;
  OwnedVector nv_derivative;
  OwnedMatrix matrix;
  OwnedSolver linear_solver;
  Owned<void*, FreeCvode> memory;

  Impl(OdeRhs f, double t0, const Eigen::VectorXd& y0,
       const CvodeOptions& options)
      : rhs(std::move(f)),
        jacobian(options.jacobian),
        max_steps(options.max_steps_per_advance),
        time(t0),
        y(y0),
        derivative(y0.size()),
        step{t0, t0, t0, 0, 0, Eigen::MatrixXd(y0.size(), kHighestOrder + 1)},
        context(make_context()),
        nv_y(make_vector(y, context.get())),
        nv_derivative(make_vector(derivative, context.get())),
        matrix(make_dense_matrix(y.size(), context.get())),
        linear_solver(make_dense_solver(y.size(), context.get())),
        memory(CVodeCreate(CV_BDF, context.get())) {
    if (!memory) throw std::runtime_error("CVodeCreate failed");
    configure(options);
  }

  void configure(const CvodeOptions& options) {
    void* mem = memory.get();
    check(CVodeSetErrHandlerFn(mem, &CallErrors::on_error, &errors),
          "CVodeSetErrHandlerFn");
    check(CVodeInit(mem, &Impl::call_rhs, time, nv_y.get()), "CVodeInit");
    check(CVodeSetUserData(mem, this), "CVodeSetUserData");
    set_tolerances(options);
    check(CVodeSetLinearSolver(mem, linear_solver.get(), matrix.get()),
          "CVodeSetLinearSolver");
    if (jacobian) {
      check(CVodeSetJacFn(mem, &Impl::call_jacobian), "CVodeSetJacFn");
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

  void check(int flag, const char* call) { errors.check(flag, call); }

  void take_step(double t_end) {
    void* mem = memory.get();
    step.begin = time;
    check(CVode(mem, t_end, nv_y.get(), &time, CV_ONE_STEP), "CVode");
    step.end = time;
    ++statistics.steps;
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

  static int call_rhs(double t, N_Vector y, N_Vector dydt, void* user) {
    Impl& self = *static_cast<Impl*>(user);
    return self.errors.guarded([&] {
      const Eigen::Index n = self.y.size();
      Eigen::Map<Eigen::VectorXd> rate(N_VGetArrayPointer(dydt), n);
      ++self.statistics.rhs_evaluations;
      self.rhs(t, Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(y), n),
               rate);
      require_finite(rate.allFinite(), "right-hand side", t);
    });
  }

  static int call_jacobian(double t, N_Vector y, N_Vector, SUNMatrix df_dy,
                           void* user, N_Vector, N_Vector, N_Vector) {
    Impl& self = *static_cast<Impl*>(user);
    return self.errors.guarded([&] {
      const Eigen::Index n = self.y.size();
      Eigen::Map<Eigen::MatrixXd> slope(SUNDenseMatrix_Data(df_dy), n, n);
      self.jacobian(t,
                    Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(y), n),
                    slope);
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
    : impl_(std::make_unique<Impl>(std::move(rhs), t0, y0, options)) {}
Cvode::~Cvode() = default;

const Eigen::VectorXd& Cvode::advance_to(
    double t_end, const std::function<void(const OdeStep&)>& on_step) {
  if (t_end == impl_->time) return impl_->y;
  impl_->check(CVodeSetStopTime(impl_->memory.get(), t_end),
               "CVodeSetStopTime");
  const long last = impl_->statistics.steps + impl_->max_steps;
  while (impl_->time != t_end) {
    if (impl_->statistics.steps >= last) {
      throw SimulationFailure("no arrival at t = " + std::to_string(t_end) +
                              " s within " + std::to_string(impl_->max_steps) +
                              " steps; reached " + std::to_string(impl_->time) +
                              " s");
    }
    impl_->take_step(t_end);
    if (on_step) {
      impl_->fill_interpolant();
      on_step(impl_->step);
    }
  }
  return impl_->y;
}

void Cvode::restart(double t, const Eigen::VectorXd& y) {
  impl_->time = t;
  impl_->y = y;
  impl_->check(CVodeReInit(impl_->memory.get(), t, impl_->nv_y.get()),
               "CVodeReInit");
}

double Cvode::time() const { return impl_->time; }
const Eigen::VectorXd& Cvode::state() const { return impl_->y; }
const CvodeStatistics& Cvode::statistics() const { return impl_->statistics; }

}  // namespace beamgyro::internal
