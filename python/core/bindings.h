// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "include/beamgyro/recording.h"

namespace beamgyro::python {

namespace py = pybind11;

// Each adds the classes and functions of one part of the library to the module
// `_core`; `_core.pyi` declares them for Python.
void bind_recording(py::module_& core);
void bind_simulation(py::module_& core);
void bind_compensation(py::module_& core);
void bind_analysis(py::module_& core);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline std::vector<double> values_of(const Doubles& values) {
  return {values.data(), values.data() + values.size()};
}

using SharedRecording = std::shared_ptr<Recording>;

/// Returns (recording, warnings).
py::tuple with_warnings(Recording&& recording,
                        const std::vector<std::string>& warnings);

}  // namespace beamgyro::python
