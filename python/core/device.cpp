// SPDX-License-Identifier: MIT
#include "include/beamgyro/device.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <span>
#include <string>
#include <vector>

#include "include/beamgyro/progress.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

py::dict characterise_device(const Device& device,
                             const std::vector<double>& temperatures) {
  const Characteristic found =
      long_call(py::none(), [device, temperatures](const Progress&) {
        return characterise(device, temperatures);
      });
  py::dict columns;
  for (const CharacteristicColumn& column : found.columns)
    columns[py::str(column.name)] = py::make_tuple(
        py::array_t<double>(static_cast<py::ssize_t>(column.values.size()),
                            column.values.data()),
        column.units);
  py::dict result;
  result["temperature"] =
      py::array_t<double>(static_cast<py::ssize_t>(found.temperature.size()),
                          found.temperature.data());
  result["columns"] = columns;
  result["warnings"] = found.warnings;
  result["csv"] = found.csv;
  return result;
}

}  // namespace

void bind_device(py::module_& core) {
  py::class_<Device>(core, "Device")
      .def_static("read", &Device::read)
      .def_static("parse", &Device::parse)
      .def("with_", &Device::with)
      .def_property_readonly("text", &Device::text)
      .def_property_readonly("name", &Device::name)
      .def_property_readonly("overrides", &Device::overrides);
  core.def("even_temperatures", &even_temperatures);
  core.def("characterise", &characterise_device);
}

}  // namespace beamgyro::python
