// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include <array>
#include <exception>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>

#include "python/core/bindings.h"

namespace beamgyro::python {
namespace {

namespace py = pybind11;
using namespace std::string_literals;

/// Options of the program and what stands for them in Python, in the words of
/// messages.
struct OptionName {
  const char *option, *argument;
};
constexpr std::array kOptionNames{
    OptionName{"axis", "axes"},
    OptionName{"chamber", "chamber_degC"},
    OptionName{"compensator", "compensator"},
    OptionName{"correlation-K", "correlation_K"},
    OptionName{"cv", "cross_validation"},
    OptionName{"dataset", "column"},
    OptionName{"device", "device"},
    OptionName{"device-id", "device_id"},
    OptionName{"devices", "devices"},
    OptionName{"figure", "figures"},
    OptionName{"fit-cubic", "fit_cubic"},
    OptionName{"force", "force"},
    OptionName{"from", "from_s"},
    OptionName{"held-out", "held_out"},
    OptionName{"hold", "hold_min"},
    OptionName{"hours", "hours"},
    OptionName{"instance", "instance"},
    OptionName{"jobs", "jobs"},
    OptionName{"limit", "limits"},
    OptionName{"ramp-K-per-min", "ramp_K_per_min"},
    OptionName{"range", "range_degC"},
    OptionName{"rate-Hz", "rate_Hz"},
    OptionName{"residual", "residual_deg_per_s"},
    OptionName{"rest", "rest"},
    OptionName{"resume", "resume"},
    OptionName{"set", "set"},
    OptionName{"soaks", "soaks"},
    OptionName{"temperature-degC", "temperature_degC"},
    OptionName{"to", "to_s"},
    OptionName{"unit", "unit"}};

/// Returns a message of the library with the arguments of Python in place of
/// the options of the program that it names: jobs=3 for --jobs 3.
std::string in_words_of_python(const std::string& message) {
  static const std::regex option(
      "(^|[^\\w-])--([A-Za-z][A-Za-z-]*)( (?=-?[0-9A-Z]))?");
  std::string words;
  auto rest = message.cbegin();
  for (std::sregex_iterator it(message.begin(), message.end(), option), end;
       it != end; ++it) {
    words.append(rest, (*it)[1].second);
    rest = (*it)[1].second;
    for (const OptionName& name : kOptionNames) {
      if ((*it)[2].str() != name.option) continue;
      const bool has_value = (*it)[3].matched && name.option != "set"s;
      words += name.argument;
      if (has_value) words += '=';
      rest = has_value ? (*it)[3].second : (*it)[2].second;
    }
  }
  return words.append(rest, message.cend());
}

/// Raises a Python exception. Bytes that are no UTF-8, such as those of a file
/// name, are written as \xff.
void raise(PyObject* type, const std::string& message) {
  const std::string words = in_words_of_python(message);
  const auto text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(words.data(), static_cast<py::ssize_t>(words.size()),
                           "backslashreplace"));
  if (text) PyErr_SetObject(type, text.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(std::move(thrown));
  } catch (const py::builtin_exception&) {
    throw;  // of pybind11, as are errors of Python
  } catch (const std::logic_error& error) {
    raise(PyExc_ValueError, error.what());
  } catch (const std::runtime_error& error) {
    raise(PyExc_RuntimeError, error.what());
  }
}

}  // namespace

void bind_errors(py::module_& core) {
  py::register_local_exception_translator(translate);
  core.def(
      "in_words_of_python",
      [](const std::string& message) { return in_words_of_python(message); },
      py::arg("message"));
}

}  // namespace beamgyro::python
