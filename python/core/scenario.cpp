// SPDX-License-Identifier: MIT
#include "include/beamgyro/scenario.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "include/beamgyro/progress.h"
#include "include/beamgyro/simulate.h"
#include "python/core/bindings.h"
#include "python/core/input_files.h"
#include "python/core/long_call.h"
#include "python/core/recording.h"

namespace beamgyro::python {
namespace {

SimulationOptions simulation_options(bool stop_on_unlock,
                                     const Progress& progress) {
  return {.stop_on_unlock = stop_on_unlock, .progress = progress};
}

py::tuple simulate_scenario(const Scenario& scenario, bool stop_on_unlock,
                            const py::object& on_progress) {
  SimulatedRun run = long_call(on_progress, [=](const Progress& progress) {
    return simulate(scenario, simulation_options(stop_on_unlock, progress));
  });
  return with_warnings(std::move(run.recording), run.warnings);
}

std::vector<std::string> simulate_into(const Scenario& scenario,
                                       const std::filesystem::path& path,
                                       bool stop_on_unlock,
                                       const py::object& on_progress) {
  return long_call(on_progress, [=](const Progress& progress) {
    return simulate_to_file(scenario, path,
                            simulation_options(stop_on_unlock, progress));
  });
}

Scenario parse(const std::string& text, const Device& device,
               const std::vector<std::string>& overrides,
               const std::string& name, const PathsAndTexts& profiles) {
  return Scenario::parse(text, device, overrides, name, input_files(profiles));
}

PathsAndTexts profiles_of(const Scenario& scenario) {
  return paths_and_texts(scenario.profiles());
}

}  // namespace

void bind_scenario(py::module_& core) {
  py::class_<Scenario>(core, "Scenario")
      .def_static("read", py::overload_cast<const std::filesystem::path&,
                                            const std::vector<std::string>&>(
                              &Scenario::read))
      .def_static(
          "read_with",
          py::overload_cast<const std::filesystem::path&, const Device&,
                            const std::vector<std::string>&>(&Scenario::read))
      .def_static("parse", &parse)
      .def("with_", &Scenario::with)
      .def("with_device", &Scenario::with_device)
      .def_property_readonly("text", &Scenario::text)
      .def_property_readonly("name", &Scenario::name)
      .def_property_readonly("device", &Scenario::device)
      .def_property_readonly("overrides", &Scenario::overrides)
      .def_property_readonly("files", &Scenario::files)
      .def_property_readonly("profiles", &profiles_of)
      .def_property_readonly("title", &Scenario::title)
      .def_property_readonly("duration", &Scenario::duration)
      .def_property_readonly("output_rate", &Scenario::output_rate)
      .def_property_readonly("samples", &Scenario::samples)
      .def_property_readonly("fidelity", &Scenario::fidelity)
      .def_property_readonly("seed", &Scenario::seed)
      .def_property_readonly("estimated_seconds", &Scenario::estimated_seconds);
  core.def("simulate", &simulate_scenario);
  core.def("simulate_to_file", &simulate_into);
}

}  // namespace beamgyro::python
