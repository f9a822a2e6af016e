// SPDX-License-Identifier: MIT
#include "sim/numerics/explicit_rk.h"

#include <arkode/arkode_arkstep.h>
#include <nvector/nvector_serial.h>

#include <stdexcept>
#include <utility>

#include "sim/numerics/sundials_objects.h"

namespace beamgyro::internal {
namespace {

struct FreeArkStep {
  void operator()(void* memory) const { ARKStepFree(&memory); }
};

ARKODE_ERKTableID table_id(RkTable table) {
  switch (table) {
    case RkTable::kDormandPrince:
      return ARKODE_DORMAND_PRINCE_7_4_5;
    case RkTable::kFehlberg:
      break;
  }
  return ARKODE_FEHLBERG_13_7_8;
}

}  // namespace

struct ExplicitRk::Impl {
  OdeRhs rhs;
  long max_steps;
  double time;
  Eigen::VectorXd y;  // ARKODE reads and writes it through `nv_y`
  long rhs_evaluations = 0;
  CallErrors errors;

  // Destroyed bottom-up: the context must outlive everything created from it.
  OwnedContext context;
  OwnedVector nv_y;
  Owned<void*, FreeArkStep> memory;

  Impl(OdeRhs f, double t0, const Eigen::VectorXd& y0,
       const ExplicitRkOptions& options)
      : rhs(std::move(f)),
        max_steps(options.max_steps_per_advance),
        time(t0),
        y(y0),
        context(make_context()),
        nv_y(make_vector(y, context.get())),
        memory(ARKStepCreate(&Impl::call_rhs, nullptr, t0, nv_y.get(),
                             context.get())) {
    if (!memory) throw std::runtime_error("ARKStepCreate failed");
    configure(options);
  }

  void check(int flag, const char* call) { errors.check(flag, call); }

  void configure(const ExplicitRkOptions& options) {
    void* mem = memory.get();
    Eigen::VectorXd absolute = full_tolerances(
        options.relative_tolerance, options.absolute_tolerance, y.size());
    const OwnedVector nv_absolute = make_vector(absolute, context.get());
    check(ARKStepSetErrHandlerFn(mem, &CallErrors::on_error, &errors),
          "ARKStepSetErrHandlerFn");
    check(ARKStepSetUserData(mem, this), "ARKStepSetUserData");
    check(
        ARKStepSVtolerances(mem, options.relative_tolerance, nv_absolute.get()),
        "ARKStepSVtolerances");
    check(ARKStepSetTableNum(mem, ARKODE_DIRK_NONE, table_id(options.table)),
          "ARKStepSetTableNum");
    check(ARKStepSetMaxNumSteps(mem, max_steps), "ARKStepSetMaxNumSteps");
    if (options.fixed_step > 0) {
      check(ARKStepSetFixedStep(mem, options.fixed_step),
            "ARKStepSetFixedStep");
    }
  }

  long steps() const {
    long count = 0;
    ARKStepGetNumSteps(memory.get(), &count);
    return count;
  }

  static int call_rhs(double t, N_Vector y, N_Vector dydt, void* user) {
    Impl& self = *static_cast<Impl*>(user);
    return self.errors.guarded([&] {
      const Eigen::Index n = self.y.size();
      Eigen::Map<Eigen::VectorXd> rate(N_VGetArrayPointer(dydt), n);
      ++self.rhs_evaluations;
      self.rhs(t, Eigen::Map<const Eigen::VectorXd>(N_VGetArrayPointer(y), n),
               rate);
      require_finite(rate.allFinite(), "right-hand side", t);
    });
  }
};

ExplicitRk::ExplicitRk(OdeRhs rhs, double t0, const Eigen::VectorXd& y0,
                       const ExplicitRkOptions& options)
    : impl_(std::make_unique<Impl>(std::move(rhs), t0, y0, options)) {}
ExplicitRk::~ExplicitRk() = default;

const Eigen::VectorXd& ExplicitRk::advance_to(double t_end) {
  if (t_end == impl_->time) return impl_->y;
  void* mem = impl_->memory.get();
  impl_->check(ARKStepSetStopTime(mem, t_end), "ARKStepSetStopTime");
  impl_->check(
      ARKStepEvolve(mem, t_end, impl_->nv_y.get(), &impl_->time, ARK_NORMAL),
      "ARKStepEvolve");
  return impl_->y;
}

void ExplicitRk::restart(double t, const Eigen::VectorXd& y) {
  impl_->time = t;
  impl_->y = y;
  impl_->check(ARKStepReset(impl_->memory.get(), t, impl_->nv_y.get()),
               "ARKStepReset");
}

double ExplicitRk::time() const { return impl_->time; }
const Eigen::VectorXd& ExplicitRk::state() const { return impl_->y; }
long ExplicitRk::steps() const { return impl_->steps(); }
long ExplicitRk::rhs_evaluations() const { return impl_->rhs_evaluations; }

}  // namespace beamgyro::internal
