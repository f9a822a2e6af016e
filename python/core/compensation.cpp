// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compensation/inputs/features.h"
#include "compensation/inputs/input.h"
#include "compensation/rows/training_rows.h"
#include "include/beamgyro/compensator.h"
#include "include/beamgyro/import.h"
#include "include/beamgyro/set.h"
#include "include/beamgyro/train.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"

namespace beamgyro::python {
namespace {

using SharedCompensator = std::shared_ptr<RateCompensator>;

/// Compensators of Python that may ask each other, one within the other.
constexpr std::size_t kMostNested = 16;

/// A Python function that takes a Recording with the measured signals of a
/// powered stretch and the name of its run, and returns (rates, sigmas or
/// None). It is called by one thread at a time: Python's own objects, such as a
/// network that is switched to answering, are not made for more.
class FunctionCompensator final : public RateCompensator {
 public:
  FunctionCompensator(std::string name, std::vector<std::string> inputs,
                      py::object function)
      : name_(std::move(name)),
        inputs_(std::move(inputs)),
        function_(gil_owned(std::move(function))) {}

  std::string name() const override { return name_; }
  std::vector<std::string> inputs() const override { return inputs_; }

  CompensatedRate answer(const Recording& recording) const override {
    require_other_callers();
    const Asked asked(this);
    const std::lock_guard lock(one_at_a_time_);  // before the GIL, not within
    const py::gil_scoped_acquire acquired;
    const auto answers =
        (*function_)(std::make_shared<Recording>(recording), recording.run)
            .cast<py::tuple>();
    CompensatedRate compensated;
    compensated.rate = values_of(answers[0].cast<Doubles>());
    if (!answers[1].is_none())
      compensated.sigma = values_of(answers[1].cast<Doubles>());
    return compensated;
  }

 private:
  // Throws std::invalid_argument where it is asked by its own answer.
  void require_other_callers() const {
    const Asked::Compensators& waiting = Asked::all();
    if (std::ranges::find(waiting, this) != waiting.end())
      throw std::invalid_argument(
          fmt::format("{}: its answer asks for its own answer", name_));
    if (waiting.size() >= kMostNested)
      throw std::invalid_argument(
          fmt::format("{}: {} compensators wait for each other's answers; "
                      "expected fewer, none of which asks for its own",
                      name_, waiting.size()));
  }

  std::string name_;
  std::vector<std::string> inputs_;
  std::shared_ptr<py::object> function_;
  mutable std::mutex one_at_a_time_;
};

SharedCompensator function_compensator(const std::string& name,
                                       const std::vector<std::string>& inputs,
                                       const py::object& function) {
  return std::make_shared<FunctionCompensator>(name, inputs, function);
}

SharedCompensator open(const std::string& argument,
                       const std::filesystem::path& program, double stall_s,
                       const std::vector<std::filesystem::path>& plugin_files,
                       bool require_isolation) {
  return std::const_pointer_cast<RateCompensator>(
      open_compensator(argument, {.stall_s = stall_s,
                                  .program = program,
                                  .plugin_files = plugin_files,
                                  .require_isolation = require_isolation}));
}

py::tuple compensate_recording(const SharedCompensator& compensator,
                               const SharedRecording& recording) {
  CompensatedRun run =
      long_call(py::none(), [compensator, recording](const Progress&) {
        return compensate(*compensator, *recording);
      });
  return with_warnings(std::move(run.recording), run.warnings);
}

/// Rows are samples, columns are inputs; NaN where unpowered.
Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> features(
    const std::vector<std::string>& inputs, const SharedRecording& recording) {
  std::vector<internal::Input> parsed;
  for (const std::string& input : inputs)
    parsed.push_back(internal::parse_input(input));
  return internal::features_of(parsed, *recording);
}

/// Returns (features, labels, cycles, legs), a row for each block; of `every_s`
/// 0 for each sample.
py::tuple rows(const std::vector<std::string>& inputs, const std::string& name,
               const SharedRecording& recording, double every_s) {
  std::vector<internal::Input> parsed;
  for (const std::string& input : inputs)
    parsed.push_back(internal::parse_input(input));
  const std::vector<internal::TrainingRun> runs = {{name, "", *recording}};
  internal::RowOptions options;
  options.seconds = every_s;
  const internal::TrainingRows found =
      internal::training_rows(internal::source_of(runs), parsed, options);
  using Rows =
      Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return py::make_tuple(Rows(found.inputs), found.bias, found.cycle, found.leg);
}

using NamedRecordings = std::vector<std::pair<std::string, SharedRecording>>;

std::vector<NamedRecording> named(const NamedRecordings& recordings) {
  std::vector<NamedRecording> all;
  for (const auto& [name, recording] : recordings)
    all.push_back({name, *recording});
  return all;
}

/// Training tells its epochs, of all restarts together.
TrainingOptions training_options(std::uint64_t seed,
                                 const std::string& cross_validation,
                                 const Progress& progress) {
  const auto on_epoch = [progress](const TrainingProgress& now) {
    const double epochs = static_cast<double>(now.max_epochs);
    const double done = static_cast<double>(now.restart) +
                        static_cast<double>(now.epoch) / epochs;
    return progress(done / static_cast<double>(now.restarts));
  };
  return {
      .seed = seed, .cross_validation = cross_validation, .progress = on_epoch};
}

py::tuple trained(TrainedCompensator found) {
  return py::make_tuple(
      std::make_shared<Compensator>(std::move(found.compensator)),
      std::move(found.warnings));
}

py::tuple train_files(const Model& model,
                      const std::vector<std::filesystem::path>& files,
                      const std::vector<std::filesystem::path>& held_out,
                      std::uint64_t seed, const std::string& cross_validation,
                      const py::object& on_progress) {
  return trained(long_call(on_progress, [=](const Progress& progress) {
    return train(model, files, held_out,
                 training_options(seed, cross_validation, progress));
  }));
}

py::tuple train_recordings(const Model& model, const NamedRecordings& runs,
                           const NamedRecordings& held_out, std::uint64_t seed,
                           const std::string& cross_validation,
                           const py::object& on_progress) {
  return trained(long_call(on_progress, [=](const Progress& progress) {
    return train(model, named(runs), named(held_out),
                 training_options(seed, cross_validation, progress));
  }));
}

py::tuple train_set(const Model& model, const Set& set,
                    const std::vector<std::string>& runs,
                    const std::vector<std::uint32_t>& devices,
                    std::uint64_t seed, const std::string& cross_validation,
                    const py::object& on_progress) {
  return trained(long_call(on_progress, [=](const Progress& progress) {
    return train(model, set, {.runs = runs, .devices = devices},
                 training_options(seed, cross_validation, progress));
  }));
}

py::tuple import_with_map(const std::filesystem::path& log,
                          const std::filesystem::path& map,
                          const std::optional<std::string>& map_text,
                          const std::string& axis,
                          const std::filesystem::path& join) {
  ImportedRecording found = long_call(py::none(), [=](const Progress&) {
    const ImportOptions options = {.axis = axis, .join = join};
    return map_text ? import_log(log, *map_text, map.string(), options)
                    : import_log(log, map, options);
  });
  return py::make_tuple(std::make_shared<Recording>(std::move(found.recording)),
                        found.text);
}

void bind_compensators(py::module_& core) {
  py::class_<RateCompensator, SharedCompensator>(core, "RateCompensator")
      .def_property_readonly("name", &RateCompensator::name)
      .def_property_readonly("inputs", &RateCompensator::inputs);
  py::class_<Compensator, RateCompensator, std::shared_ptr<Compensator>>(
      core, "Compensator")
      .def_static("parse", &Compensator::parse)
      .def("write", &Compensator::write)
      .def_property_readonly("text", &Compensator::text)
      .def_property_readonly("method", &Compensator::method)
      .def_property_readonly("lowest_temperature",
                             &Compensator::lowest_temperature)
      .def_property_readonly("highest_temperature",
                             &Compensator::highest_temperature)
      .def_property_readonly("warnings", &Compensator::warnings)
      .def_property_readonly("curve", &Compensator::curve);
}

}  // namespace

void bind_compensation(py::module_& core) {
  bind_compensators(core);
  core.def("function_compensator", &function_compensator);
  core.def("open_compensator", &open);
  core.def("compensate", &compensate_recording);
  core.def("features", &features);
  core.def("training_rows", &rows);
  py::class_<Model>(core, "Model")
      .def_static("read", &Model::read)
      .def_static("parse", &Model::parse)
      .def_property_readonly("text", &Model::text)
      .def_property_readonly("name", &Model::name);
  core.def("import_log", &import_with_map);
  core.def("train_files", &train_files);
  core.def("train_recordings", &train_recordings);
  core.def("train_set", &train_set);
}

}  // namespace beamgyro::python
