// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "python/core/bindings.h"

namespace beamgyro::python {
namespace {

namespace py = pybind11;

/// An option of the program and what stands for it in Python.
struct OptionName {
  std::string_view option, argument;
};
constexpr std::array kOptionNames{
    OptionName{"axis", "axes"},
    OptionName{"chamber", "chamber_degC"},
    OptionName{"correlation-K", "correlation_K"},
    OptionName{"cv", "cross_validation"},
    OptionName{"dataset", "column"},
    OptionName{"device", "device"},
    OptionName{"device-id", "device_id"},
    OptionName{"devices", "devices"},
    OptionName{"fit-cubic", "fit_cubic"},
    OptionName{"force", "force"},
    OptionName{"from", "from_s"},
    OptionName{"held-out", "held_out"},
    OptionName{"hold", "hold_min"},
    OptionName{"hours", "hours"},
    OptionName{"instance", "instance"},
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

/// What stands before an option in the library's own words. An option after
/// anything else is part of a name or a command of the user's.
constexpr std::array<std::string_view, 14> kBeforeOptions{
    "; ",  "expected ", "expected no ", "pass ",    "below ",
    "or ", "and ",      "such as ",     "one of ",  "narrower ",
    "by ", "earlier ",  "which ",       "generate "};

/// Returns the option that `text` begins with, or nullptr.
const OptionName* option_at(std::string_view text) {
  if (!text.starts_with("--")) return nullptr;
  const std::string_view name = text.substr(
      2, std::min(text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                         "abcdefghijklmnopqrstuvwxyz-"),
                  text.size()) -
             2);
  const auto* const found =
      std::ranges::find(kOptionNames, name, &OptionName::option);
  return found == kOptionNames.end() ? nullptr : found;
}

/// Whether a value comes after an option: a number or a word of capitals.
bool begins_value(std::string_view text) {
  if (!text.starts_with(' ')) return false;
  text.remove_prefix(text.starts_with(" -") ? 2 : 1);
  return !text.empty() && ((text.front() >= '0' && text.front() <= '9') ||
                           (text.front() >= 'A' && text.front() <= 'Z'));
}

/// Returns a message of the library with the arguments of Python in place of
/// the options of the program that it names: jobs=3 for --jobs 3.
std::string in_words_of_python(const std::string& message) {
  std::string words;
  bool may_begin = true;  // an option, here
  for (std::size_t k = 0; k < message.size();) {
    may_begin = may_begin || std::ranges::any_of(
                                 kBeforeOptions, [&](std::string_view before) {
                                   return words.ends_with(before);
                                 });
    const OptionName* const option =
        may_begin ? option_at(std::string_view(message).substr(k)) : nullptr;
    may_begin = false;
    if (option == nullptr) {
      words += message[k++];
      continue;
    }
    words += option->argument;
    k += 2 + option->option.size();
    if (option->option == "set" ||
        !begins_value(std::string_view(message).substr(k)))
      continue;
    const std::size_t end = std::min(message.find(' ', k + 1), message.size());
    words += '=' + message.substr(k + 1, end - k - 1);
    k = end;
    if (message.compare(k, 3, " --") != 0) continue;
    words += message[k++];  // --from 3 --to 2
    may_begin = true;
  }
  return words;
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
  } catch (const std::bad_alloc&) {
    raise(PyExc_MemoryError, "there is not enough memory for this call");
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
