// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace beamgyro::python {

// Each adds the classes and functions of one header of the library to the
// module `_core`; `_core.pyi` declares them for Python. bind_errors() gives
// exceptions of the library the words of Python.
void bind_errors(pybind11::module_& core);
void bind_recording(pybind11::module_& core);
void bind_device(pybind11::module_& core);
void bind_scenario(pybind11::module_& core);
void bind_set(pybind11::module_& core);
void bind_compensation(pybind11::module_& core);
void bind_analysis(pybind11::module_& core);

}  // namespace beamgyro::python
