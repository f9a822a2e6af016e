// SPDX-License-Identifier: MIT
#include "sim/numerics/cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cassert>
#include <exception>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace beamgyro {
namespace {

static_assert(std::is_same_v<sunrealtype, double>);

constexpr Eigen::Index kHighestOrder = 12;  // of CVODE's Adams formulas

struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
struct FreeVector {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
struct FreeMatrix {
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
struct FreeCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};

template <class Handle, class Free>  // every SUNDIALS handle is a pointer
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

template <class Handle>
Handle created(Handle handle, const char* call) {
  if (!handle) throw std::runtime_error(std::string(call) + " failed");
  return handle;
}

SUNContext create_context() {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  return context;
}

void require_finite(bool finite, const char* what, double t) {
  if (!finite) {
    throw std::runtime_error(std::string(what) + " is not finite at t = " +
                             std::to_string(t) + " s");
  }
}

void require_tolerances(const CvodeOptions& options, Eigen::Index size) {
  const Eigen::VectorXd& absolute = options.absolute_tolerance;
  if (absolute.size() != 1 && absolute.size() != size) {
    throw std::invalid_argument(
        "absolute_tolerance has " + std::to_string(absolute.size()) +
        " entries for " + std::to_string(size) + " components");
  }
  if (!(options.relative_tolerance >= 0) || !(absolute.array() >= 0).all()) {
    throw std::invalid_argument("a tolerance is negative or not a number");
  }
}

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
  std::exception_ptr callback_error;
  std::string message;

  // Destroyed bottom-up: the context must outlive everything created from it.
  Owned<SUNContext, FreeContext> context;
  Owned<N_Vector, FreeVector> nv_y;
  Owned<N_Vector, FreeVector> nv_derivative;
  Owned<SUNMatrix, FreeMatrix> matrix;
  Owned<SUNLinearSolver, FreeSolver> linear_solver;
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
        context(created(create_context(), "SUNContext_Create")),
        nv_y(wrap(y)),
        nv_derivative(wrap(derivative)),
        matrix(created(SUNDenseMatrix(y.size(), y.size(), context.get()),
                       "SUNDenseMatrix")),
        linear_solver(
            created(SUNLinSol_Dense(nv_y.get(), matrix.get(), context.get()),
                    "SUNLinSol_Dense")),
        memory(created(
            CVodeCreate(options.method == OdeMethod::kBdf ? CV_BDF : CV_ADAMS,
                        context.get()),
            "CVodeCreate")) {
    configure(options);
  }

  N_Vector wrap(Eigen::VectorXd& values) const {
    return created(N_VMake_Serial(values.size(), values.data(), context.get()),
                   "N_VMake_Serial");
  }

  void configure(const CvodeOptions& options) {
    void* mem = memory.get();
    check(CVodeSetErrHandlerFn(mem, &Impl::on_error, this),
          "CVodeSetErrHandlerFn");
    check(CVodeInit(mem, &Impl::call_rhs, time, nv_y.get()), "CVodeInit");
    check(CVodeSetUserData(mem, this), "CVodeSetUserData");
    set_tolerances(options);
    check(CVodeSetLinearSolver(mem, linear_solver.get(), matrix.get()),
          "CVodeSetLinearSolver");
    if (jacobian) {
      check(CVodeSetJacFn(mem, &Impl::call_jacobian), "CVodeSetJacFn");
    }
    if (options.max_order > 0) {
      check(CVodeSetMaxOrd(mem, options.max_order), "CVodeSetMaxOrd");
    }
    if (options.stability_limit_detection) {
      check(CVodeSetStabLimDet(mem, SUNTRUE), "CVodeSetStabLimDet");
    }
    check(CVodeSetInitStep(mem, options.initial_step), "CVodeSetInitStep");
    check(CVodeSetMaxStep(mem, options.max_step), "CVodeSetMaxStep");
  }

  void set_tolerances(const CvodeOptions& options) {
    require_tolerances(options, y.size());
    Eigen::VectorXd absolute = options.absolute_tolerance;
    if (absolute.size() == 1) {
      check(CVodeSStolerances(memory.get(), options.relative_tolerance,
                              absolute(0)),
            "CVodeSStolerances");
      return;
    }
    const Owned<N_Vector, FreeVector> nv_absolute(wrap(absolute));
    check(CVodeSVtolerances(memory.get(), options.relative_tolerance,
                            nv_absolute.get()),
          "CVodeSVtolerances");
  }

  void check(int flag, const char* call) {
    if (callback_error) {
      std::rethrow_exception(std::exchange(callback_error, nullptr));
    }
    if (flag < 0) {
      throw std::runtime_error(std::string(call) + " failed (flag " +
                               std::to_string(flag) + "): " + message);
    }
  }

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

  // C callbacks: an exception must not unwind through CVODE's C frames.
  template <class Work>
  int guarded(const Work& work) {
    try {
      work();
      return 0;
    } catch (...) {
      callback_error = std::current_exception();
      return -1;  // unrecoverable: CVODE stops and check() rethrows
    }
  }

  static int call_rhs(double t, N_Vector y, N_Vector dydt, void* user) {
    Impl& self = *static_cast<Impl*>(user);
    return self.guarded([&] {
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
    return self.guarded([&] {
      const Eigen::Index n = self.y.size();
      Eigen::Map<Eigen::MatrixXd> slope(SUNDenseMatrix_Data(df_dy), n, n);
      ++self.statistics.jacobians;
      self.jacobian(t,
                    Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(y), n),
                    slope);
      require_finite(slope.allFinite(), "Jacobian", t);
    });
  }

  static void on_error(int, const char*, const char*, char* text, void* user) {
    static_cast<Impl*>(user)->message = text;
  }
};

Eigen::VectorXd OdeStep::at(double t) const {
  const double s = (t - centre) / size;
  Eigen::VectorXd y = coefficients.col(order);
  for (Eigen::Index k = order - 1; k >= 0; --k) y = y * s + coefficients.col(k);
  return y;
}

void OdeStep::sample(Eigen::Index component, std::span<const double> times,
                     std::span<double> values) const {
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
    Block y = Block::Constant(n, coefficients(component, order));
    for (Eigen::Index k = order - 1; k >= 0; --k) {
      y = y * s + coefficients(component, k);
    }
    Eigen::Map<Eigen::ArrayXd>(values.data() + first, n) = y;
  }
}

Cvode::Cvode(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
             const CvodeOptions& options)
    : impl_(std::make_unique<Impl>(std::move(rhs), t0, y0, options)) {}
Cvode::~Cvode() = default;
Cvode::Cvode(Cvode&&) noexcept = default;
Cvode& Cvode::operator=(Cvode&&) noexcept = default;

const Eigen::VectorXd& Cvode::advance_to(
    double t_end, const std::function<void(const OdeStep&)>& on_step) {
  if (t_end == impl_->time) return impl_->y;
  impl_->check(CVodeSetStopTime(impl_->memory.get(), t_end),
               "CVodeSetStopTime");
  const long last = impl_->statistics.steps + impl_->max_steps;
  while (impl_->time != t_end) {
    if (impl_->statistics.steps >= last) {
      throw std::runtime_error("no arrival at t = " + std::to_string(t_end) +
                               " s within " + std::to_string(impl_->max_steps) +
                               " steps; reached " +
                               std::to_string(impl_->time) + " s");
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
  ++impl_->statistics.restarts;
  impl_->check(CVodeReInit(impl_->memory.get(), t, impl_->nv_y.get()),
               "CVodeReInit");
}

double Cvode::time() const { return impl_->time; }
const Eigen::VectorXd& Cvode::state() const { return impl_->y; }
const CvodeStatistics& Cvode::statistics() const { return impl_->statistics; }

}  // namespace beamgyro
