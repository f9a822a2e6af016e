// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "include/beamgyro/compensator.h"
#include "include/beamgyro/recording.h"

namespace beamgyro::python {

namespace py = pybind11;

// Each adds the classes and functions of one part of the library to the module
// `_core`; `_core.pyi` declares them for Python.
void bind_recording(py::module_& core);
void bind_simulation(py::module_& core);
void bind_compensation(py::module_& core);
void bind_analysis(py::module_& core);
void bind_gyro(py::module_& core);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline std::vector<double> values_of(const Doubles& values) {
  return {values.data(), values.data() + values.size()};
}

using SharedRecording = std::shared_ptr<Recording>;

/// Takes a shared object from Python, and no None.
template <class Object>
class SomeCaster
    : public py::detail::copyable_holder_caster<Object,
                                                std::shared_ptr<Object>> {
 public:
  bool load(py::handle source, bool convert) {
    return !source.is_none() &&
           py::detail::copyable_holder_caster<
               Object, std::shared_ptr<Object>>::load(source, convert);
  }
};

/// Returns (recording, warnings).
py::tuple with_warnings(Recording&& recording,
                        const std::vector<std::string>& warnings);

}  // namespace beamgyro::python

namespace pybind11::detail {

template <>
class type_caster<std::shared_ptr<beamgyro::Recording>>
    : public beamgyro::python::SomeCaster<beamgyro::Recording> {};
template <>
class type_caster<std::shared_ptr<beamgyro::RateCompensator>>
    : public beamgyro::python::SomeCaster<beamgyro::RateCompensator> {};

}  // namespace pybind11::detail
