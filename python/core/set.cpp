// SPDX-License-Identifier: MIT
#include "include/beamgyro/set.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "include/beamgyro/campaign.h"
#include "python/core/bindings.h"
#include "python/core/input_files.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

py::list parameters_of(const Set& set, const std::string& run,
                       std::uint32_t device) {
  py::list all;
  for (const DrawnParameter& drawn : set.drawn_parameters(run, device))
    all.append(
        py::make_tuple(drawn.name, drawn.value, drawn.units, drawn.long_name));
  return all;
}

py::list failures_of(const Set& set) {
  py::list all;
  for (const SetFailure& failure : set.failures())
    all.append(py::make_tuple(failure.run, failure.device, failure.reason));
  return all;
}

py::list verify(const Set& set, const py::object& on_progress) {
  const std::vector<SetDefect> found = long_call(
      on_progress,
      [set](const Progress& progress) { return set.verify(progress); });
  py::list all;
  for (const SetDefect& defect : found)
    all.append(py::make_tuple(defect.file, defect.what));
  return all;
}

py::tuple generate_set(const Campaign& campaign,
                       const std::filesystem::path& directory, unsigned jobs,
                       bool resume, const py::object& on_progress) {
  GenerationOutcome outcome =
      long_call(on_progress, [=](const Progress& progress) {
        return generate(campaign, directory,
                        {.jobs = jobs, .resume = resume, .progress = progress});
      });
  return py::make_tuple(outcome.failures, std::move(outcome.warnings),
                        std::move(outcome.text));
}

Campaign parse_campaign(const PathsAndTexts& files,
                        std::optional<std::uint32_t> devices) {
  return Campaign::parse(input_files(files), devices);
}

PathsAndTexts files_of(const Campaign& campaign) {
  return paths_and_texts(campaign.files());
}

}  // namespace

void bind_set(py::module_& core) {
  py::class_<Campaign>(core, "Campaign")
      .def_static("read", &Campaign::read)
      .def_static("parse", &parse_campaign)
      .def_property_readonly("name", &Campaign::name)
      .def_property_readonly("text", &Campaign::text)
      .def_property_readonly("files", &files_of)
      .def_property_readonly("devices", &Campaign::devices)
      .def_property_readonly("seed", &Campaign::seed)
      .def_property_readonly("runs", &Campaign::runs)
      .def("device", &Campaign::device);
  core.def("generate", &generate_set);
  py::class_<Set>(core, "Set")
      .def_static("open", &Set::open)
      .def_property_readonly("directory", &Set::directory)
      .def_property_readonly("campaign", &Set::campaign)
      .def_property_readonly("devices", &Set::devices)
      .def_property_readonly("runs", &Set::runs)
      .def_property_readonly("seed", &Set::seed)
      .def_property_readonly("program_version", &Set::program_version)
      .def_property_readonly("git_revision", &Set::git_revision)
      .def_property_readonly("failures", &failures_of)
      .def("part",
           [](const Set& set, std::uint32_t device) {
             return part_name(set.part(device));
           })
      .def("recording", &Set::recording,
           py::call_guard<py::gil_scoped_release>())
      .def("slow_recording", &Set::slow_recording,
           py::call_guard<py::gil_scoped_release>())
      .def("parameters", &parameters_of)
      .def("verify", &verify);
}

}  // namespace beamgyro::python
