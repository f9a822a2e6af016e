// SPDX-License-Identifier: MIT
#include "include/beamgyro/export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "api/checked_number.h"
#include "api/compensators.h"
#include "api/export_parts.h"
#include "compensation/export/export_c.h"
#include "compensation/export/export_ekf.h"
#include "compensation/export/export_parameters.h"
#include "compensation/firmware/c_text.h"
#include "config/option_message.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"
#include "dataset/files/sha256.h"

namespace beamgyro {
namespace internal {
namespace {

struct ExportRequest {
  const std::vector<Compensator>& compensators;
  const std::string& format;
  const ExportOptions& options;
};

const FittedCompensator& compensator_of(const ExportRequest& asked,
                                        std::size_t k) {
  return asked.compensators[k].content().compensator;
}

// In messages.
std::string file_of(const ExportRequest& asked, std::size_t k) {
  return asked.compensators[k].content().path();
}

void warn_of_ranges(const std::vector<AutopilotAxis>& axes,
                    std::vector<std::string>& warnings) {
  const TemperatureRange common = common_range(axes);
  if (std::ranges::all_of(axes, [&](const AutopilotAxis& axis) {
        return axis.range == common;
      }))
    return;
  warnings.push_back(fmt::format(
      "the axes were trained over different temperatures: the autopilot will "
      "clamp all of them to {:.2f} to {:.2f} degC, which all have seen",
      common.lowest, common.highest));
}

void parameter_texts(const ExportRequest& asked, const std::string& name,
                     ExportResult& result) {
  const std::vector<char> places =
      axes_of(asked.options.axes, asked.compensators.size(), "compensators");
  std::vector<AutopilotAxis> axes;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const FittedCompensator& compensator = compensator_of(asked, k);
    const auto cubic = [&] {
      return autopilot_cubic(compensator, asked.options.fit_cubic);
    };
    axes.push_back({places[k], of_file(file_of(asked, k), cubic),
                    compensator.temperature_range});
  }
  const bool px4 = asked.format == "px4";
  const auto gyro_id = asked.options.device_id.value_or(0);
  if (gyro_id < 0 || gyro_id > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument(
        fmt::format("device id {}: expected 0 to {}", gyro_id,
                    std::numeric_limits<std::int32_t>::max()));
  const AutopilotGyro gyro{asked.options.instance.value_or(px4 ? 0 : 1),
                           static_cast<long>(gyro_id)};
  result.files.push_back(
      {name + (px4 ? ".params" : ".parm"), of_file(file_of(asked, 0), [&] {
         return px4 ? px4_parameters(axes, gyro)
                    : ardupilot_parameters(axes, gyro);
       })});
  warn_of_ranges(axes, result.warnings);
  if (px4 && gyro_id == 0)
    result.warnings.emplace_back(
        "TC_Gn_ID is 0: PX4 applies the parameters to the sensor with this id "
        "only; expected its device id");
}

void c_texts(const ExportRequest& asked, const std::string& name,
             ExportResult& result) {
  const ExportedC c = of_file(file_of(asked, 0), [&] {
    return export_c(compensator_of(asked, 0), name, asked.options.force);
  });
  for (const std::string& warning : c.warnings)
    result.warnings.push_back(
        fmt::format("{}: {}", file_of(asked, 0), warning));
  result.files = {{name + ".h", c.header},
                  {name + ".c", c.source},
                  {name + "_selftest.c", c.self_test},
                  {name + "_plugin.c", c.plugin}};
}

// Before a long recording is read.
void require_sigma(const ExportRequest& asked) {
  const FittedCompensator& c = compensator_of(asked, 0);
  if (!c.sigma)
    throw std::invalid_argument(fmt::format(
        "{}: states no sigma, from which the bias noise of a filter is "
        "computed{}; expected a compensator with the member sigma",
        file_of(asked, 0),
        c.sigma_not_known.empty() ? "" : ": " + c.sigma_not_known));
}

void ekf_files(const ExportRequest& asked, const std::string& name,
               ExportResult& result) {
  const ExportOptions& options = asked.options;
  if (!options.rest)
    throw option_error(
        "{} is missing; expected a recording at rest, from which the noise is "
        "taken",
        NamedOption{"rest"});
  const Compensator& own = asked.compensators[0];
  const FittedCompensator& compensator = own.content().compensator;
  EkfExport given{.name = name,
                  .axis = axes_of(asked.options.axes, asked.compensators.size(),
                                  "compensators")[0],
                  .compensator = {own.name(), sha256(own.text())},
                  .rest = {},
                  .settings = {},
                  .noise = {},
                  .figures = {}};
  EkfSettings& settings = given.settings;
  settings.temperature = options.temperature_degC;
  if (options.ramp_K_per_min)
    settings.temperature_rate = *options.ramp_K_per_min / 60.0;
  settings.correlation = options.correlation_K.value_or(settings.correlation);
  require_sigma(asked);
  std::vector<std::string> of_file_read;
  const Recording rest = beamgyro::read_recording(*options.rest, &of_file_read);
  given.noise = of_file(options.rest->string(),
                        [&] { return rest_noise(compensator, rest); });
  given.rest = {options.rest->filename().string(),
                sha256_of_file(*options.rest)};
  given.figures = ekf_figures(compensator, given.noise, settings);
  result.warnings = ekf_warnings(given);
  result.warnings.insert(result.warnings.end(), of_file_read.begin(),
                         of_file_read.end());
  for (auto& [called, text] : ekf_texts(given))
    result.files.push_back({called, std::move(text)});
}

void require_options(const ExportRequest& asked) {
  check_number("ramp_K_per_min", asked.options.ramp_K_per_min, {0.0, 1000.0});
  check_number("correlation_K", asked.options.correlation_K, positive());
  check_number("temperature_degC", asked.options.temperature_degC,
               {-273.15, 1000.0});
  const ExportOptions& o = asked.options;
  const std::tuple<bool, const char*, std::string_view> formats_of[] = {
      {o.device_id.has_value(), "device_id", "px4"},
      {o.force, "force", "c"},
      {o.rest.has_value(), "rest", "ekf"},
      {o.ramp_K_per_min.has_value(), "ramp_K_per_min", "ekf"},
      {o.correlation_K.has_value(), "correlation_K", "ekf"},
      {o.temperature_degC.has_value(), "temperature_degC", "ekf"},
      {!o.axes.empty(), "axes", "px4, ardupilot and ekf"},
      {o.instance.has_value(), "instance", "px4 and ardupilot"},
      {o.fit_cubic, "fit_cubic", "px4 and ardupilot"}};
  for (const auto& [given, option, formats] : formats_of)
    if (given && formats.find(asked.format) == formats.npos)
      throw option_error("{}: is for the formats {}, not for {}",
                         NamedOption{option}, formats, asked.format);
  if (asked.format == "px4" || asked.format == "ardupilot") return;
  if (asked.compensators.size() > 1)
    throw std::invalid_argument(fmt::format(
        "several compensators: is for the formats px4 and ardupilot, not for "
        "{}",
        asked.format));
}

void require_words(const ExportRequest& asked) {
  constexpr std::array<std::string_view, 4> kFormats = {"c", "px4", "ardupilot",
                                                        "ekf"};
  if (std::ranges::count(kFormats, asked.format) == 0)
    throw std::invalid_argument(fmt::format(
        "format \"{}\"; expected {}", asked.format, fmt::join(kFormats, ", ")));
  require_axes(asked.options.axes);
  if (asked.compensators.empty() || asked.compensators.size() > 3)
    throw std::invalid_argument(
        fmt::format("{} compensators; expected one, or up to three",
                    asked.compensators.size()));
}

}  // namespace
}  // namespace internal

ExportResult export_files(const std::vector<Compensator>& compensators,
                          const std::string& format,
                          const ExportOptions& options) {
  const internal::ExportRequest asked{compensators, format, options};
  internal::require_words(asked);
  internal::require_options(asked);
  const std::string name = internal::c_identifier(
      options.name.empty()
          ? std::filesystem::path(compensators[0].name()).stem().string()
          : options.name);
  ExportResult result;
  if (format == "c")
    internal::c_texts(asked, name, result);
  else if (format == "ekf")
    internal::ekf_files(asked, name, result);
  else
    internal::parameter_texts(asked, name, result);
  return result;
}

// Files that are open at once; a process has places for 64.
constexpr std::size_t kMostFiles = 16;

void write_exported(const std::filesystem::path& directory,
                    const std::vector<ExportedFile>& files) {
  if (files.size() > kMostFiles)
    throw std::invalid_argument(
        fmt::format("{} files; expected at most {}", files.size(), kMostFiles));
  std::set<std::string_view> names;
  for (const ExportedFile& file : files) {
    if (std::filesystem::path(file.name).filename() != file.name ||
        file.name.empty() || file.name == "." || file.name == "..")
      throw std::invalid_argument(
          fmt::format("'{}': expected the name of a file in the directory {}",
                      file.name, directory.string()));
    if (!names.insert(file.name).second)
      throw std::invalid_argument(fmt::format(
          "{}: the name of two files; expected one each", file.name));
  }
  const internal::MadeDirectories made(directory);
  // All are complete beside those that they replace before the first does.
  std::vector<std::unique_ptr<internal::AtomicFile>> written;
  for (const ExportedFile& file : files) {
    const std::filesystem::path path = directory / file.name;
    written.push_back(std::make_unique<internal::AtomicFile>(path));
    internal::write_partial_file(*written.back(), path, file.text);
  }
  for (const auto& file : written) file->publish();
}

}  // namespace beamgyro
