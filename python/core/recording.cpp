// SPDX-License-Identifier: MIT
#include "dataset/recording/recording.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dataset/netcdf/recording_reader.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/signals.h"
#include "python/core/bindings.h"

namespace beamgyro::python {
namespace {

using Bytes =
    py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>;

/// Returns an array that refers to `values`, which `owner` keeps alive.
template <class Number>
py::array array_of(const std::vector<Number>& values, const py::object& owner) {
  return py::array_t<Number>(static_cast<py::ssize_t>(values.size()),
                             values.data(), owner);
}

/// Calls visit(name, column) for each variable in the order of a file; the
/// column is null for `time` and `status`.
template <class Visit>
void for_each_variable(const Recording& recording, const Visit& visit) {
  visit(std::string("time"), nullptr);
  const std::size_t status_at = internal::status_position(recording);
  for (std::size_t i = 0; i <= recording.columns.size(); ++i) {
    if (i == status_at) visit(std::string("status"), nullptr);
    if (i < recording.columns.size())
      visit(recording.columns[i].name, &recording.columns[i]);
  }
}

py::dict arrays_of(const py::object& self) {
  const Recording& recording = *self.cast<SharedRecording>();
  py::dict arrays;
  for_each_variable(recording, [&](const std::string& name,
                                   const Column* column) {
    arrays[py::str(name)] = column != nullptr ? array_of(column->values, self)
                            : name == "time"  ? array_of(recording.time, self)
                                             : array_of(recording.status, self);
  });
  return arrays;
}

py::dict attributes_of(const internal::VariableAbout& about) {
  py::dict attributes;
  attributes["units"] = about.units;
  attributes["long_name"] = about.long_name;
  attributes["role"] = role_name(about.role);
  if (!about.comment.empty()) attributes["comment"] = about.comment;
  const std::string_view standard = internal::standard_name_of(about.name);
  if (!standard.empty()) attributes["standard_name"] = standard;
  return attributes;
}

py::dict attributes_of(const std::string& name, const Column* column) {
  if (column != nullptr)
    return attributes_of({column->name, column->units, column->long_name,
                          column->role, column->comment});
  if (name == "time") {
    py::dict attributes = attributes_of({"time", "s", "time"});
    attributes["axis"] = "T";
    return attributes;
  }
  py::dict attributes = attributes_of(internal::status_about());
  attributes["flag_masks"] = py::array_t<std::uint8_t>(
      internal::kStatusMasks.size(), internal::kStatusMasks.data());
  attributes["flag_meanings"] = internal::kStatusMeanings;
  return attributes;
}

py::dict variable_attributes(const Recording& recording) {
  py::dict all;
  for_each_variable(recording,
                    [&](const std::string& name, const Column* column) {
                      all[py::str(name)] = attributes_of(name, column);
                    });
  return all;
}

py::dict file_attributes(const Recording& recording) {
  const py::module_ numpy = py::module_::import("numpy");
  py::dict attributes;
  attributes["Conventions"] = internal::kConventions;
  attributes["filetype"] = internal::kRecordingFiletype;
  attributes["format_version"] =
      numpy.attr("int32")(internal::kRecordingFormatVersion);
  attributes["beamgyro_version"] = recording.program_version;
  attributes["git_revision"] = recording.git_revision;
  attributes["seed"] = numpy.attr("uint64")(recording.seed);
  attributes["fidelity"] = recording.fidelity;
  attributes["source"] = internal::source_text(
      recording.fidelity, recording.program_version, recording.git_revision);
  const std::array<std::pair<const char*, const std::string*>, 4> texts = {
      {{"title", &recording.title},
       {"history", &recording.history},
       {"compensator", &recording.compensator},
       {"compensator_sha256", &recording.compensator_sha256}}};
  for (const auto& [name, text] : texts)
    if (!text->empty()) attributes[name] = *text;
  return attributes;
}

Role role_of(std::string_view name) {
  for (const Role role : {Role::kMeasured, Role::kTruth, Role::kCompensated})
    if (role_name(role) == name) return role;
  throw std::invalid_argument(fmt::format(
      "role \"{}\": expected \"measured\", \"truth\" or \"compensated\"",
      name));
}

/// A column with the attributes of a variable; those of a signal that beamgyro
/// knows where they are missing.
Column column_of(const std::string& name, const Doubles& values,
                 const std::map<std::string, std::string>& attributes) {
  const internal::RecordedSignal* known = internal::find_recorded_signal(name);
  Column column{name, "1", name, Role::kMeasured, values_of(values)};
  if (known != nullptr) {
    column.units = known->units;
    column.long_name = known->long_name;
    column.role = known->role;
  }
  for (const auto& [attribute, text] : attributes) {
    if (attribute == "units") {
      if (known != nullptr && text != known->units)
        throw std::invalid_argument(fmt::format(
            "{}: units \"{}\"; expected \"{}\"", name, text, known->units));
      column.units = text;
    }
    if (attribute == "long_name") column.long_name = text;
    if (attribute == "role") column.role = role_of(text);
    if (attribute == "comment") column.comment = text;
  }
  return column;
}

void require_length(const Recording& recording, const std::string& name,
                    std::size_t length) {
  if (length != recording.time.size())
    throw std::invalid_argument(
        fmt::format("{}: {} values; expected {}, one for each time", name,
                    length, recording.time.size()));
}

SharedRecording new_recording(const Doubles& time, const Bytes& status) {
  auto recording = std::make_shared<Recording>();
  recording->time = values_of(time);
  recording->status = {status.data(), status.data() + status.size()};
  require_length(*recording, "status", recording->status.size());
  return recording;
}

void add_column(Recording& recording, const std::string& name,
                const Doubles& values,
                const std::map<std::string, std::string>& attributes) {
  if (find_column(recording, name) != nullptr)
    throw std::invalid_argument(fmt::format("{}: is there already", name));
  recording.columns.push_back(column_of(name, values, attributes));
  require_length(recording, name, recording.columns.back().values.size());
}

/// The unit of a variable that beamgyro knows; empty for another one, and for
/// one without a unit.
std::string unit_of(const std::string& name) {
  const std::string_view unit = internal::unit_of_variable(name);
  return unit == "1" ? "" : std::string(unit);
}

void require_sound(const Recording& recording) {
  const std::string defect = internal::recording_defect(recording);
  if (!defect.empty()) throw std::invalid_argument(defect);
}

py::tuple read(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  Recording recording = [&] {
    const py::gil_scoped_release released;
    return read_recording(path, &warnings);
  }();
  return with_warnings(std::move(recording), warnings);
}

}  // namespace

py::tuple with_warnings(Recording&& recording,
                        const std::vector<std::string>& warnings) {
  return py::make_tuple(std::make_shared<Recording>(std::move(recording)),
                        warnings);
}

void bind_recording(py::module_& core) {
  core.def("unit_of", &unit_of);
  py::class_<Recording, SharedRecording> recording(core, "Recording");
  recording.def("add", &add_column)
      .def("require_sound", &require_sound)
      .def("arrays", &arrays_of)
      .def("variable_attributes", &variable_attributes)
      .def("file_attributes", &file_attributes)
      .def("write", &write_recording, py::call_guard<py::gil_scoped_release>());
  for (const auto& [name, member] :
       {std::pair{"fidelity", &Recording::fidelity},
        {"title", &Recording::title},
        {"history", &Recording::history},
        {"compensator", &Recording::compensator},
        {"compensator_sha256", &Recording::compensator_sha256},
        {"program_version", &Recording::program_version},
        {"git_revision", &Recording::git_revision},
        {"scenario_text", &Recording::scenario_text},
        {"device_text", &Recording::device_text},
        {"overrides_text", &Recording::overrides_text}})
    recording.def_readwrite(name, member);
  recording.def_readwrite("seed", &Recording::seed);
  core.def("new_recording", &new_recording);
  core.def("read_recording", &read);
}

}  // namespace beamgyro::python
