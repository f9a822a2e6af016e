// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include <chrono>

#include "include/beamgyro/version.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

PYBIND11_MODULE(_core, core) {
  namespace python = beamgyro::python;
  core.doc() = "The compiled part of beamgyro.";
  core.attr("version") = beamgyro::version();
  core.attr("git_revision") = beamgyro::git_revision();
  python::bind_errors(core);
  python::bind_kinds(core);
  python::bind_recording(core);
  python::bind_device(core);
  python::bind_scenario(core);
  python::bind_set(core);
  python::bind_compensation(core);
  python::bind_analysis(core);
  python::bind_plan(core);
  // Work that was interrupted must not outlive the interpreter.
  core.def("wait_for_left_work", [] {
    const pybind11::gil_scoped_release released;
    python::LeftWork::wait(std::chrono::seconds{5});
  });
  pybind11::module_::import("atexit").attr("register")(
      core.attr("wait_for_left_work"));
}
