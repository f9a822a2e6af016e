// SPDX-License-Identifier: MIT
#include "include/beamgyro/gyro.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dataset/recording/signals.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

/// How an input is called in Python.
const char* name_of(const GyroInputSignal& input) {
  return input.value == &GyroInputs::ambient_temperature ? "ambient"
                                                         : input.name;
}
const std::span<const GyroInputSignal> kInputs = gyro_inputs();
constexpr std::size_t kInputCount = 7;

/// A sample with its truth.
struct Shown {
  GyroSample sample;
  GyroTruth truth;
};

Shown now(const Gyro& gyro) { return {gyro.now(), gyro.truth()}; }

double number_of(const py::handle& given, const char* name) {
  if (PyFloat_Check(given.ptr())) return PyFloat_AS_DOUBLE(given.ptr());
  if (!PyLong_Check(given.ptr()) && py::hasattr(given, "attrs"))
    throw std::invalid_argument(
        fmt::format("{}: is an array of xarray, whose unit a step does not "
                    "read; expected a number",
                    name));
  if (!PyBool_Check(given.ptr()) && PyNumber_Check(given.ptr()) != 0) {
    const double value = PyFloat_AsDouble(given.ptr());
    if (PyErr_Occurred() == nullptr) return value;
    PyErr_Clear();
  }
  throw std::invalid_argument(fmt::format("{} {}: is no number; expected one",
                                          name,
                                          py::repr(given).cast<std::string>()));
}

bool truth_of(const py::handle& given) {
  if (PyBool_Check(given.ptr())) return given.ptr() == Py_True;
  throw std::invalid_argument(fmt::format("powered {}: expected True or False",
                                          py::repr(given).cast<std::string>()));
}

/// What is given for an input: nothing, a number, or a pair of them.
void take_input(const py::handle& given, const GyroInputSignal& input,
                GyroInputs& from, GyroInputs& to) {
  if (given.is_none()) return;
  if (!py::isinstance<py::tuple>(given) && !py::isinstance<py::list>(given)) {
    from.*input.value = to.*input.value = number_of(given, name_of(input));
    return;
  }
  const auto pair = py::reinterpret_borrow<py::sequence>(given);
  if (pair.size() != 2)
    throw std::invalid_argument(
        fmt::format("{} has {} values; expected a number, or a pair of them "
                    "for the begin and the end of the step",
                    name_of(input), pair.size()));
  from.*input.value = number_of(py::object(pair[0]), name_of(input));
  to.*input.value = number_of(py::object(pair[1]), name_of(input));
}

using Given = std::array<py::handle, kInputCount>;

void take_inputs(const Given& given, const py::handle& powered,
                 GyroInputs& from, GyroInputs& to) {
  for (std::size_t i = 0; i < kInputs.size(); ++i)
    take_input(given[i], kInputs[i], from, to);
  if (!powered.is_none()) from.powered = to.powered = truth_of(powered);
}

Gyro start_gyro(const Device& device, const std::string& fidelity,
                std::uint64_t seed, bool noise, double noise_rate_Hz,
                bool stirred, std::optional<double> temperature_degC,
                std::optional<double> age_hours,
                const std::vector<std::pair<double, double>>& history,
                const std::vector<double>& inputs, bool powered) {
  GyroStart start{.fidelity = fidelity,
                  .seed = seed,
                  .noise = noise,
                  .noise_rate_Hz = noise_rate_Hz,
                  .stirred = stirred,
                  .temperature_degC = temperature_degC,
                  .age_hours = age_hours,
                  .history = history};
  for (std::size_t i = 0; i < kInputs.size(); ++i)
    start.inputs.*kInputs[i].value = inputs.at(i);
  start.inputs.powered = powered;
  return Gyro(device, start);
}

Shown step(Gyro& self, const py::object& dt, const py::object& rate,
           const py::object& cross_rate_x, const py::object& cross_rate_y,
           const py::object& acceleration_x, const py::object& acceleration_y,
           const py::object& acceleration_z, const py::object& ambient,
           const py::object& powered) {
  GyroInputs from = self.inputs(), to = from;
  take_inputs({rate, cross_rate_x, cross_rate_y, acceleration_x, acceleration_y,
               acceleration_z, ambient},
              powered, from, to);
  self.step(number_of(dt, "dt"), from, to);
  return now(self);
}

using Arrays = std::map<std::string, Doubles>;

/// The inputs of `count` steps or gyros: those of `values`, else `others`.
std::vector<GyroInputs> inputs_of(const Arrays& values,
                                  std::vector<GyroInputs> inputs) {
  for (const auto& [name, array] : values) {
    if (static_cast<std::size_t>(array.size()) != inputs.size())
      throw std::invalid_argument(
          fmt::format("{} has {} values; expected {}, one for each", name,
                      array.size(), inputs.size()));
    if (name == "powered") {
      for (std::size_t k = 0; k < inputs.size(); ++k)
        inputs[k].powered = array.data()[k] != 0;
      continue;
    }
    for (const GyroInputSignal& input : kInputs)
      if (name == name_of(input))
        for (std::size_t k = 0; k < inputs.size(); ++k)
          inputs[k].*input.value = array.data()[k];
  }
  return inputs;
}

SharedRecording advance(Gyro& self, double dt, std::size_t count,
                        const Arrays& values, bool linear,
                        const py::object& on_progress) {
  const auto inputs =
      inputs_of(values, std::vector<GyroInputs>(count, self.inputs()));
  // A copy: work that was stopped may go on for a while.
  auto gyro = std::make_shared<Gyro>(self);
  Recording recording = long_call(on_progress, [=](const Progress& progress) {
    return gyro->advance(
        dt, inputs, linear ? GyroSteps::kLinear : GyroSteps::kHeld, progress);
  });
  self = std::move(*gyro);
  return std::make_shared<Recording>(std::move(recording));
}

py::dict shown_arrays(const std::vector<Shown>& all) {
  const auto count = static_cast<py::ssize_t>(all.size());
  py::dict arrays;
  const auto put = [&](const char* name, const auto& value) {
    py::array_t<double> values(count);
    double* const out = values.mutable_data();
    for (std::size_t k = 0; k < all.size(); ++k) out[k] = value(all[k]);
    arrays[name] = values;
  };
  put("time", [](const Shown& s) { return s.sample.time; });
  for (const GyroSignal& signal : gyro_signals())
    put(signal.name,
        [&](const Shown& s) { return signal.of(s.sample, s.truth); });
  py::array_t<std::uint8_t> status(count);
  for (std::size_t k = 0; k < all.size(); ++k)
    status.mutable_data()[k] = all[k].sample.status;
  arrays["status"] = status;
  return arrays;
}

py::dict step_each(const std::vector<Gyro*>& gyros, double dt,
                   const Arrays& begin, const Arrays& end, unsigned jobs) {
  std::vector<GyroInputs> last;
  for (const Gyro* gyro : gyros) last.push_back(gyro->inputs());
  const std::vector<GyroInputs> from = inputs_of(begin, last);
  const std::vector<GyroInputs> to = inputs_of(end, last);
  {
    const py::gil_scoped_release released;
    step_all(gyros, dt, from, to, jobs);
  }
  std::vector<Shown> all;
  for (const Gyro* gyro : gyros) all.push_back(now(*gyro));
  return shown_arrays(all);
}

}  // namespace

void bind_gyro(py::module_& core) {
  py::class_<Shown> sample(core, "Sample",
                           "What a gyro shows at one moment, under the names "
                           "and in the units of a recording.");
  sample
      .def_property_readonly(
          "time", [](const Shown& s) { return s.sample.time; },
          "Time since the start [s].")
      .def_property_readonly(
          "status", [](const Shown& s) { return s.sample.status; },
          "Bits of the status, as in recordings.")
      .def_property_readonly(
          "truth", [](const Shown& s) { return s.truth; },
          "The truth at the same moment, which no gyro shows.");
  py::class_<GyroTruth> truth(core, "Truth",
                              "The truth at the moment of a sample, which no "
                              "gyro shows.");
  for (const GyroSignal& signal : gyro_signals()) {
    const internal::RecordedSignal& about =
        internal::recorded_signal(signal.name);
    const std::string text =
        fmt::format("The {} [{}].", about.long_name, about.units);
    if (signal.measured != nullptr)
      sample.def_property_readonly(
          signal.name,
          [member = signal.measured](const Shown& s) {
            return s.sample.*member;
          },
          text.c_str());
    else
      truth.def_property_readonly(
          signal.name,
          [member = signal.truth](const GyroTruth& t) { return t.*member; },
          text.c_str());
  }
  py::class_<Gyro>(core, "Gyro")
      .def_static("start", &start_gyro)
      .def("now", &now)
      .def("step", &step)
      .def("advance", &advance)
      .def("copy", [](const Gyro& self) { return Gyro(self); })
      .def("state", [](const Gyro& self) { return py::bytes(self.state()); })
      .def("restore",
           [](Gyro& self, const std::string& state) { self.restore(state); });
  core.def("step_all", &step_each);
}

}  // namespace beamgyro::python
