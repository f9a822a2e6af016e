// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <vector>

#include "api/file_kind.h"
#include "python/core/bindings.h"

namespace beamgyro::python {
namespace {

std::vector<std::string> kinds_of(const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const internal::FileKind kind : internal::kinds_of(path))
    names.emplace_back(internal::kind_name(kind));
  return names;
}

}  // namespace

void bind_kinds(pybind11::module_& core) {
  core.def("kinds_of", &kinds_of, pybind11::arg("path"));
}

}  // namespace beamgyro::python
