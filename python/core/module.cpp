// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include "include/beamgyro/version.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

PYBIND11_MODULE(_core, core) {
  namespace python = beamgyro::python;
  core.doc() = "The compiled part of beamgyro.";
  core.attr("version") = beamgyro::version();
  core.attr("git_revision") = beamgyro::git_revision();
  python::bind_errors(core);
  python::bind_recording(core);
  python::bind_device(core);
  python::bind_scenario(core);
  python::bind_set(core);
  python::bind_compensation(core);
  python::bind_analysis(core);
  core.def("end_running_work", &python::end_running_work);
  pybind11::module_::import("atexit").attr("register")(
      core.attr("end_running_work"));
}
