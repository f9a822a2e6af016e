// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/file_kind.h"
#include "api/validation_members.h"
#include "include/beamgyro/allan.h"
#include "include/beamgyro/campaign.h"
#include "include/beamgyro/curves.h"
#include "include/beamgyro/device.h"
#include "include/beamgyro/device_design.h"
#include "include/beamgyro/export.h"
#include "include/beamgyro/option_error.h"
#include "include/beamgyro/plan.h"
#include "include/beamgyro/sensitivity.h"
#include "include/beamgyro/validate.h"
#include "python/core/bindings.h"
#include "python/core/long_call.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::python {
namespace {

using Path = std::filesystem::path;

/// Sets `member` to the entry `name` of `given`, if there is one.
template <class Member>
void take(const py::dict& given, const char* name, Member& member) {
  if (given.contains(name)) member = given[name].cast<Member>();
}

/// Returns (text, JSON, warnings), what every analysis gives.
template <class Result>
py::tuple report_of(Result&& found) {
  return py::make_tuple(found.text, found.json, found.warnings);
}

/// Returns the report of allan_of(options).
template <class Allan>
py::tuple allan_report(const py::dict& given, const Allan& allan_of) {
  AllanOptions options;
  take(given, "kinds", options.kinds);
  take(given, "taus", options.taus);
  take(given, "from_s", options.from_s);
  take(given, "to_s", options.to_s);
  return report_of(long_call(py::none(), [=](const Progress& progress) mutable {
    options.progress = progress;
    return allan_of(options);
  }));
}

py::tuple allan_recording(const SharedRecording& recording,
                          const std::string& column, const py::dict& given) {
  return allan_report(given, [=](const AllanOptions& options) {
    return allan(*recording, column, options);
  });
}

py::tuple allan_samples(const Doubles& samples, double rate_Hz,
                        const std::string& unit, const py::dict& given) {
  return allan_report(
      given, [=, values = values_of(samples)](const AllanOptions& options) {
        return allan(values, rate_Hz, unit, options);
      });
}

py::tuple allan_file(const Path& file, const std::optional<std::string>& column,
                     const std::optional<double>& rate_Hz,
                     const std::optional<std::string>& unit,
                     const py::dict& given) {
  return allan_report(given, [=](const AllanOptions& options) {
    return allan_of_file(
        file, {.column = column, .rate_Hz = rate_Hz, .unit = unit}, options);
  });
}

/// Returns a metric that calls a Python function with (name, purpose,
/// recording, rate) of each run, by one thread at a time.
OwnMetric own_metric(const py::tuple& row) {
  const std::string name = row[0].cast<std::string>();
  const auto function = gil_owned(row[2].cast<py::object>());
  const auto one_at_a_time = std::make_shared<std::mutex>();
  return {
      name, row[1].cast<std::string>(),
      [function, one_at_a_time](const std::vector<OwnMetricRun>& runs) {
        const std::lock_guard lock(*one_at_a_time);  // before the GIL
        const py::gil_scoped_acquire acquired;
        py::list given;
        for (const OwnMetricRun& run : runs)
          given.append(py::make_tuple(
              run.name, run.purpose, std::make_shared<Recording>(run.recording),
              Doubles(static_cast<py::ssize_t>(run.rate.size()),
                      run.rate.data())));
        return (*function)(given).cast<double>();
      }};
}

ValidationOptions validation_options(const py::dict& given) {
  ValidationOptions options;
  for (const internal::ValidationMember& row : internal::validation_members())
    std::visit(
        [&](auto member) {
          const std::string name(row.name);
          auto& value = options.*member;
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>,
                                       std::vector<OwnMetric>>) {
            if (given.contains(name.c_str()))
              for (const py::handle& one : given[name.c_str()])
                value.push_back(own_metric(one.cast<py::tuple>()));
          } else {
            take(given, name.c_str(), value);
          }
        },
        row.member);
  take(given, "jobs", options.jobs);
  return options;
}

/// Returns (keyword, member, type, kind of its file, subjects, what it is) of
/// each option.
std::vector<py::tuple> validation_members() {
  std::vector<py::tuple> rows;
  for (const internal::ValidationMember& row : internal::validation_members())
    if (!row.help.empty())
      rows.push_back(py::make_tuple(
          row.python, row.name, internal::type_name(row),
          row.kind ? internal::kind_name(*row.kind) : std::string_view(),
          internal::subject_names(row), row.help));
  return rows;
}

py::tuple outcome_of(const ValidationOutcome& outcome) {
  return py::make_tuple(outcome.text, outcome.json, outcome.warnings,
                        outcome.page, outcome.junit, outcome.trained);
}

/// Runs a validation; errors about options name the keywords of Python.
py::tuple validated(
    const py::object& on_progress, const py::dict& given,
    const std::function<ValidationOutcome(const ValidationOptions&)>& run) try {
  return outcome_of(
      long_call(on_progress, [run, options = validation_options(given)](
                                 const Progress& progress) mutable {
        options.progress = progress;
        return run(options);
      }));
} catch (const OptionError& error) {
  throw std::invalid_argument(
      error.words([](std::string_view name, std::string_view value) {
        const std::string keyword(internal::member_named(name).python);
        return value.empty() ? keyword : keyword + "=" + std::string(value);
      }));
}

py::tuple validate_compensator(
    const std::shared_ptr<RateCompensator>& compensator, const py::dict& given,
    const py::object& on_progress) {
  return validated(on_progress, given,
                   [compensator](const ValidationOptions& options) {
                     return validate(*compensator, options);
                   });
}

py::tuple validate_model(const Model& model, const py::dict& given,
                         const py::object& on_progress) {
  return validated(on_progress, given,
                   [model](const ValidationOptions& options) {
                     return validate(model, options);
                   });
}

py::tuple plan_soaks(const Compensator& population, const Device& device,
                     const py::dict& given) {
  PlanOptions options;
  take(given, "soaks", options.soaks);
  take(given, "hours", options.hours);
  take(given, "residual_deg_per_s", options.residual_deg_per_s);
  take(given, "range_degC", options.range_degC);
  take(given, "chamber_degC", options.chamber_degC);
  take(given, "ramp_K_per_min", options.ramp_K_per_min);
  take(given, "start_degC", options.start_degC);
  take(given, "hold_min", options.hold_min);
  take(given, "candidates", options.candidates);
  take(given, "bias_only", options.bias_only);
  take(given, "start_row", options.start_row);
  take(given, "device_name", options.device_name);
  const SoakPlanResult found =
      long_call(py::none(), [population, device, options](const Progress&) {
        return plan(population, device, options);
      });
  return py::make_tuple(found.text, found.json, found.warnings, found.schedule);
}

py::tuple study_sensitivity(const Campaign& campaign, const py::dict& given,
                            const py::object& on_progress) {
  SensitivityOptions options;
  take(given, "figures", options.figures);
  take(given, "lowest_degC", options.lowest_degC);
  take(given, "highest_degC", options.highest_degC);
  take(given, "linear", options.linear);
  take(given, "limits", options.limits);
  take(given, "yield", options.yield);
  take(given, "samples", options.samples);
  take(given, "seed", options.seed);
  take(given, "jobs", options.jobs);
  if (given.contains("compensator"))
    options.compensator = given["compensator"].cast<Compensator>();
  const SensitivityResult found = long_call(
      on_progress, [campaign, options](const Progress& progress) mutable {
        options.progress = progress;
        return sensitivity(campaign, options);
      });
  return py::make_tuple(found.text, found.json, std::vector<std::string>{});
}

py::tuple describe_curves(const std::vector<double>& temperatures,
                          const std::vector<double>& curves,
                          const std::vector<std::uint32_t>& units,
                          const py::dict& given, const std::string& name) {
  CurveTreatment treatment;
  take(given, "lowest_degC", treatment.lowest_degC);
  take(given, "highest_degC", treatment.highest_degC);
  take(given, "zero_at_degC", treatment.zero_at_degC);
  take(given, "round_deg_per_s", treatment.round_deg_per_s);
  const CurveFigureResult found = long_call(py::none(), [=](const Progress&) {
    return curve_figures(temperatures, curves, units, treatment, name);
  });
  return py::make_tuple(found.text, found.json, std::vector<std::string>{});
}

double area_between(const std::vector<double>& one,
                    const std::vector<double>& other) {
  return area_metric(one, other);
}

double area_to_table(const std::vector<double>& sample,
                     const std::vector<double>& shares,
                     const std::vector<double>& values) {
  return area_metric_of_table(sample, shares, values);
}

py::tuple split_in_halves(const std::vector<double>& sample, std::size_t draws,
                          std::uint64_t seed) {
  const HalfSplitDistance found = long_call(py::none(), [=](const Progress&) {
    return half_split(sample, draws, seed);
  });
  return py::make_tuple(found.median, found.p95);
}

/// Returns (names and texts of the files, warnings).
py::tuple files_and_warnings(const ExportResult& found) {
  py::list files;
  for (const ExportedFile& file : found.files)
    files.append(py::make_tuple(file.name, file.text));
  return py::make_tuple(files, found.warnings);
}

py::tuple export_compensators(const std::vector<Compensator>& compensators,
                              const std::string& format,
                              const py::dict& given) {
  ExportOptions options;
  take(given, "name", options.name);
  take(given, "axes", options.axes);
  take(given, "force", options.force);
  take(given, "fit_cubic", options.fit_cubic);
  take(given, "instance", options.instance);
  take(given, "device_id", options.device_id);
  take(given, "rest", options.rest);
  take(given, "ramp_K_per_min", options.ramp_K_per_min);
  take(given, "correlation_K", options.correlation_K);
  take(given, "temperature_degC", options.temperature_degC);
  const ExportResult found =
      long_call(py::none(), [compensators, format, options](const Progress&) {
        return export_files(compensators, format, options);
      });
  return files_and_warnings(found);
}

py::tuple export_to_simulator(const std::vector<Device>& devices,
                              const std::vector<Compensator>& compensators,
                              const std::string& format,
                              const py::dict& given) {
  SimulatorExportOptions options;
  take(given, "name", options.name);
  take(given, "axes", options.axes);
  take(given, "fit_cubic", options.fit_cubic);
  take(given, "instance", options.instance);
  take(given, "range_degC", options.range_degC);
  take(given, "temperature_degC", options.temperature_degC);
  take(given, "update_rate_Hz", options.update_rate_Hz);
  return files_and_warnings(long_call(py::none(), [=](const Progress&) {
    return export_for_simulator(devices, compensators, format, options);
  }));
}

/// Returns (text, figures as tuples, warnings).
py::tuple design_of(const Device& base, const py::dict& given) {
  DataSheet sheet;
  take(given, "length", sheet.length);
  take(given, "side", sheet.side);
  take(given, "frequency_Hz", sheet.frequency_Hz);
  take(given, "split_Hz", sheet.split_Hz);
  take(given, "quality", sheet.quality);
  take(given, "air_quality", sheet.air_quality);
  take(given, "mount", sheet.mount);
  take(given, "range_deg_per_s", sheet.range_deg_per_s);
  take(given, "full_scale_deg_per_s", sheet.full_scale_deg_per_s);
  take(given, "scale_factor_V_per_deg_per_s",
       sheet.scale_factor_V_per_deg_per_s);
  take(given, "bandwidth_Hz", sheet.bandwidth_Hz);
  take(given, "noise_deg_per_s_per_sqrt_Hz", sheet.noise_deg_per_s_per_sqrt_Hz);
  take(given, "walk_deg_per_sqrt_h", sheet.walk_deg_per_sqrt_h);
  take(given, "instability_deg_per_h", sheet.instability_deg_per_h);
  take(given, "null_deg_per_s", sheet.null_deg_per_s);
  take(given, "scale_tolerance_percent", sheet.scale_tolerance_percent);
  take(given, "adc_bits", sheet.adc_bits);
  take(given, "bits", sheet.bits);
  take(given, "sensor_range_degC", sheet.sensor_range_degC);
  take(given, "resolution_K", sheet.resolution_K);
  take(given, "sensor_tolerance_K", sheet.sensor_tolerance_K);
  take(given, "supply_V", sheet.supply_V);
  take(given, "current_A", sheet.current_A);
  take(given, "power_W", sheet.power_W);
  take(given, "self_heating_K", sheet.self_heating_K);
  take(given, "warm_up_s", sheet.warm_up_s);
  take(given, "temperature_degC", sheet.temperature_degC);
  const DesignedDevice made = long_call(
      py::none(), [=](const Progress&) { return design_device(base, sheet); });
  py::list figures;
  for (const DesignFigure& one : made.figures)
    figures.append(py::make_tuple(one.name, one.unit, one.asked, one.measured,
                                  one.is_met()));
  return py::make_tuple(made.text, figures, made.warnings);
}

}  // namespace

void bind_analysis(py::module_& core) {
  core.def("plan", &plan_soaks);
  core.def("kinds_of", [](const Path& path) {
    std::vector<std::string_view> names;
    for (const internal::FileKind kind : internal::kinds_of(path))
      names.push_back(internal::kind_name(kind));
    return names;
  });
  core.def("allan_recording", &allan_recording);
  core.def("allan_samples", &allan_samples);
  core.def("allan_file", &allan_file);
  core.def("validate", &validate_compensator);
  core.def("validation_members", &validation_members);
  core.def("random_seed", &random_seed);
  core.def("source_kind", [](const std::string& argument) {
    return internal::kind_name(internal::source_kind(argument));
  });
  core.def("validate_model", &validate_model);
  core.def("sensitivity", &study_sensitivity);
  core.def("curve_figures", &describe_curves);
  core.def("area_metric", &area_between);
  core.def("area_metric_of_table", &area_to_table);
  core.def("half_split", &split_in_halves);
  core.def("write_texts",
           [](const Path& directory,
              const std::vector<std::pair<std::string, std::string>>& texts) {
             std::vector<ExportedFile> files;
             for (const auto& [name, text] : texts)
               files.push_back({name, text});
             write_exported(directory, files);
           });
  core.def("export_files", &export_compensators);
  core.def("export_for_simulator", &export_to_simulator);
  core.def("design_device", &design_of);
}

}  // namespace beamgyro::python
