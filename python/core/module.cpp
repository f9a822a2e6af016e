// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "include/beamgyro/option_error.h"
#include "include/beamgyro/progress.h"
#include "include/beamgyro/version.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

std::string in_python(std::string_view name, std::string_view value) {
  return std::string(name).append(value.empty() ? "" : "=").append(value);
}

/// Raises a Python exception. Bytes that are no UTF-8, such as those of a file
/// name, are written as \xff.
void raise(PyObject* type, const std::string& message) {
  const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
      message.data(), static_cast<py::ssize_t>(message.size()),
      "backslashreplace"));
  if (text) PyErr_SetObject(type, text.ptr());
}

/// Gives exceptions of the library the words of Python.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(std::move(thrown));
  } catch (const py::builtin_exception&) {
    throw;  // of pybind11, as are errors of Python
  } catch (const std::bad_alloc&) {
    raise(PyExc_MemoryError, "there is not enough memory for this call");
  } catch (const OptionError& error) {
    raise(PyExc_ValueError, error.words(in_python));
  } catch (const std::logic_error& error) {
    raise(PyExc_ValueError, error.what());
  } catch (const std::runtime_error& error) {
    raise(PyExc_RuntimeError, error.what());
  }
}

/// Keeps Python from making objects of the classes of `core`, which only its
/// functions return: one without a value inside would crash when it is used.
void refuse_new_objects(const py::module_& core) {
  const py::cpp_function refuse(
      [](const py::args&, const py::kwargs&) -> py::object {
        throw py::type_error(
            "has no constructor; expected a call of the package beamgyro");
      });
  for (const auto& [name, value] : core.attr("__dict__").cast<py::dict>())
    if (py::isinstance<py::type>(value)) value.attr("__new__") = refuse;
}

}  // namespace
}  // namespace beamgyro::python

PYBIND11_MODULE(_core, core) {
  namespace python = beamgyro::python;
  core.doc() = "The compiled part of beamgyro.";
  core.attr("version") = beamgyro::version();
  pybind11::register_local_exception_translator(python::translate);
  python::bind_recording(core);
  python::bind_simulation(core);
  python::bind_compensation(core);
  python::bind_analysis(core);
  python::bind_gyro(core);
  python::refuse_new_objects(core);
  const auto cancelled =
      pybind11::register_local_exception<beamgyro::Cancelled>(
          core, "Cancelled", PyExc_RuntimeError);
  cancelled.attr("__module__") = "beamgyro";
  cancelled.attr("__doc__") = "A function of the progress returned False.";
  core.def("end_running_work", &python::end_running_work);
  pybind11::module_::import("atexit").attr("register")(
      core.attr("end_running_work"));
}
