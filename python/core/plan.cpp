// SPDX-License-Identifier: MIT
#include "include/beamgyro/plan.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "include/beamgyro/compensator.h"
#include "include/beamgyro/device.h"
#include "python/core/bindings.h"
#include "python/core/given_options.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

py::tuple plan_soaks(const Compensator& population, const Device& device,
                     const py::dict& given) {
  PlanOptions options;
  take(given, "soaks", options.soaks);
  take(given, "hours", options.hours);
  take(given, "residual_deg_per_s", options.residual_deg_per_s);
  take(given, "range_degC", options.range_degC);
  take(given, "chamber_degC", options.chamber_degC);
  take(given, "ramp_K_per_min", options.ramp_K_per_min);
  take(given, "start_degC", options.start_degC);
  take(given, "hold_min", options.hold_min);
  take(given, "candidates", options.candidates);
  take(given, "bias_only", options.bias_only);
  take(given, "device_name", options.device_name);
  const SoakPlanResult found =
      long_call(py::none(), [population, device, options](const Progress&) {
        return plan(population, device, options);
      });
  return py::make_tuple(found.text, found.json, found.warnings, found.schedule);
}

}  // namespace

void bind_plan(py::module_& core) {
  core.def("plan", &plan_soaks, py::arg("population"), py::arg("device"),
           py::arg("options"));
}

}  // namespace beamgyro::python
