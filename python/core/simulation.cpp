// SPDX-License-Identifier: MIT
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "include/beamgyro/campaign.h"
#include "include/beamgyro/card.h"
#include "include/beamgyro/curves.h"
#include "include/beamgyro/device.h"
#include "include/beamgyro/scenario.h"
#include "include/beamgyro/set.h"
#include "include/beamgyro/simulate.h"
#include "include/beamgyro/variants.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

/// Files as Python has them: tuples of path and bytes. A profile may be in
/// another encoding than UTF-8.
using PathsAndTexts = std::vector<std::pair<std::filesystem::path, py::bytes>>;

std::vector<InputFile> input_files(const PathsAndTexts& files) {
  std::vector<InputFile> all;
  for (const auto& [path, text] : files) all.push_back({path, text});
  return all;
}

PathsAndTexts paths_and_texts(const std::vector<InputFile>& files) {
  PathsAndTexts all;
  for (const InputFile& file : files)
    all.emplace_back(file.path, py::bytes(file.text));
  return all;
}

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
  py::list crossings;
  for (const SpuriousCrossing& one : found.crossings)
    crossings.append(py::dict(
        py::arg("mode") = one.mode, py::arg("temperature") = one.temperature,
        py::arg("height") = one.height, py::arg("width") = one.width));
  result["crossings"] = crossings;
  result["warnings"] = found.warnings;
  result["csv"] = found.csv;
  return result;
}

py::dict characterise_campaign(const Campaign& campaign,
                               const std::vector<double>& temperatures,
                               unsigned jobs, const py::object& on_progress) {
  const CampaignCurves found =
      long_call(on_progress, [=](const Progress& progress) {
        return characterise(campaign, temperatures,
                            {.jobs = jobs, .progress = progress});
      });
  const std::array<py::ssize_t, 2> shape = {
      static_cast<py::ssize_t>(found.devices.size()),
      static_cast<py::ssize_t>(found.temperature.size())};
  py::dict columns;
  for (const CharacteristicColumn& column : found.columns)
    columns[py::str(column.name)] = py::make_tuple(
        py::array_t<double>(shape, column.values.data()), column.units);
  py::dict result;
  result["device"] = found.devices;
  result["columns"] = columns;
  result["warnings"] = found.warnings;
  result["csv"] = found.csv;
  return result;
}

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

/// Returns (recording, warnings with the number of their runs). The columns of
/// the recording have the values of all runs, run after run; its times are
/// those of one.
py::tuple simulate_all(const Scenario& scenario,
                       const std::vector<VariedValues>& axes,
                       const std::vector<std::string>& variables, unsigned jobs,
                       const py::object& on_progress) {
  VariantRuns runs = long_call(on_progress, [=](const Progress& progress) {
    return simulate_variants(
        scenario, axes,
        {.jobs = jobs, .variables = variables, .progress = progress});
  });
  py::list warnings;
  for (const VariantWarning& warning : runs.warnings)
    warnings.append(py::make_tuple(warning.text, warning.runs));
  auto all = std::make_shared<Recording>();
  all->time = std::move(runs.time);
  all->status = std::move(runs.status);
  all->columns = std::move(runs.columns);
  return py::make_tuple(std::move(all), warnings);
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
                       bool resume,
                       const std::pair<std::uint32_t, std::uint32_t>& shard,
                       const py::object& on_progress) {
  GenerationOutcome outcome =
      long_call(on_progress, [=](const Progress& progress) {
        return generate(campaign, directory,
                        {.jobs = jobs,
                         .resume = resume,
                         .progress = progress,
                         .shard = shard.first,
                         .shards = shard.second});
      });
  return py::make_tuple(outcome.failures, std::move(outcome.warnings),
                        outcome.is_whole);
}

std::vector<std::string> write_set_card(
    const Set& set, const std::map<std::string, std::string>& texts,
    const py::object& on_progress) {
  return long_call(on_progress, [=](const Progress& progress) {
    SetCardOptions options{.license = texts.at("license"),
                           .url = texts.at("url"),
                           .creator = texts.at("creator"),
                           .date = texts.at("date"),
                           .version = texts.at("version"),
                           .progress = progress};
    return write_card(set, options);
  });
}

Campaign parse_campaign(const PathsAndTexts& files,
                        std::optional<std::uint32_t> devices) {
  return Campaign::parse(input_files(files), devices);
}

PathsAndTexts files_of(const Campaign& campaign) {
  return paths_and_texts(campaign.files());
}

}  // namespace

void bind_simulation(py::module_& core) {
  py::class_<Device>(core, "Device")
      .def_static("read", &Device::read)
      .def_static("parse", &Device::parse)
      .def("with_", py::overload_cast<const std::vector<std::string>&>(
                        &Device::with, py::const_))
      .def_property_readonly("text", &Device::text)
      .def_property_readonly("name", &Device::name)
      .def_property_readonly("overrides", &Device::overrides);
  core.def("even_temperatures", &even_temperatures);
  core.def("characterise", &characterise_device);
  py::class_<Scenario>(core, "Scenario")
      .def_static("read", py::overload_cast<const std::filesystem::path&,
                                            const std::vector<std::string>&>(
                              &Scenario::read))
      .def_static(
          "read_with",
          py::overload_cast<const std::filesystem::path&, const Device&,
                            const std::vector<std::string>&>(&Scenario::read))
      .def_static("parse", &parse)
      .def("with_", py::overload_cast<const std::vector<std::string>&>(
                        &Scenario::with, py::const_))
      .def("with_device", &Scenario::with_device)
      .def_property_readonly("text", &Scenario::text)
      .def_property_readonly("name", &Scenario::name)
      .def_property_readonly("device", &Scenario::device)
      .def_property_readonly("overrides", &Scenario::overrides)
      .def_property_readonly("profiles", &profiles_of)
      .def_property_readonly("title", &Scenario::title)
      .def_property_readonly("duration", &Scenario::duration)
      .def_property_readonly("output_rate", &Scenario::output_rate)
      .def_property_readonly("samples", &Scenario::samples)
      .def_property_readonly("fidelity", &Scenario::fidelity)
      .def_property_readonly("seed", &Scenario::seed);
  core.def("simulate", &simulate_scenario);
  core.def("simulate_to_file", &simulate_into);
  core.def("simulate_variants", &simulate_all);
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
  core.def("characterise_campaign", &characterise_campaign);
  core.def("generate", &generate_set);
  py::class_<Set>(core, "Set")
      .def_static("open", &Set::open)
      .def_property_readonly("directory", &Set::directory)
      .def_property_readonly("devices", &Set::devices)
      .def_property_readonly("runs", &Set::runs)
      .def_property_readonly("seed", &Set::seed)
      .def_property_readonly("failures", &failures_of)
      .def("part",
           [](const Set& set, std::uint32_t device) {
             return part_name(set.part(device));
           })
      .def("recording", &Set::recording, py::arg("run"), py::arg("device"),
           py::arg("variables") = std::vector<std::string>(),
           py::call_guard<py::gil_scoped_release>())
      .def("slow_recording", &Set::slow_recording,
           py::call_guard<py::gil_scoped_release>())
      .def("parameters", &parameters_of)
      .def("verify", &verify)
      .def("write_card", &write_set_card);
}

}  // namespace beamgyro::python
