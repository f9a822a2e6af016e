// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/log/csv_file.h"
#include "dataset/log/recording_csv.h"
#include "dataset/recording/units.h"
#include "report/allan_report.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kRateUnit = "deg/s";
constexpr double kSameRate = 0.01;  // [-], of two sample rates

struct AllanArguments {
  std::string file, json;
  std::optional<std::string> dataset, unit;
  std::optional<double> rate, from, to;
  std::vector<std::string> kinds;
  std::string taus = "octave";
};

/// The signal whose deviations are computed.
struct Signal {
  Recording recording;  // holds the column
  std::string column, unit;
  std::vector<std::string> warnings;
};

bool is_time(const std::string& name) {
  return name == "time" || name == "time_s";
}

std::string csv_column(const AllanArguments& arguments, const CsvTable& csv) {
  if (arguments.dataset) return *arguments.dataset;
  std::vector<std::string> signals = csv.names;
  std::erase_if(signals, is_time);
  if (signals.size() == 1) return signals.front();
  if (std::ranges::count(signals, "rate") == 1) return "rate";
  throw std::invalid_argument(
      fmt::format("{}: has {} columns; expected --dataset NAME to choose one",
                  arguments.file, csv.columns.size()));
}

void require_increasing(const CsvTable& csv, const std::vector<double>& time) {
  for (std::size_t k = 1; k < time.size(); ++k)
    if (!(time[k] > time[k - 1]))
      throw std::invalid_argument(
          fmt::format("{}: the time {} s follows {} s; expected times that "
                      "increase",
                      csv.place(k), time[k], time[k - 1]));
}

/// The column of times, converted to seconds from the unit in its brackets.
std::vector<double> time_in_seconds(const AllanArguments& arguments,
                                    const CsvTable& csv,
                                    const std::string& name,
                                    const std::string& unit) {
  std::vector<double> time = csv.column(name);
  try {
    const UnitConversion conversion =
        unit_conversion(unit.empty() ? "s" : unit, "s");
    for (double& value : time) value = conversion(value);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{}:1: {}: {}", arguments.file, name, error.what()));
  }
  require_increasing(csv, time);
  return time;
}

std::vector<double> csv_time(const AllanArguments& arguments,
                             const CsvTable& csv,
                             const std::vector<std::string>& units) {
  const auto name = std::ranges::find_if(csv.names, is_time);
  if (name != csv.names.end())
    return time_in_seconds(
        arguments, csv, *name,
        units[static_cast<std::size_t>(name - csv.names.begin())]);
  if (!arguments.rate)
    throw std::invalid_argument(
        fmt::format("{}: a CSV series without a column \"time\" [s] has no "
                    "sample rate; expected --rate-Hz",
                    arguments.file));
  std::vector<double> time(csv.columns.front().size());
  for (std::size_t k = 0; k < time.size(); ++k)
    time[k] = static_cast<double>(k) / *arguments.rate;
  return time;
}

/// Angular rates are converted to deg/s. Numbers in another unit stay.
void convert(std::string& unit, std::vector<double>& values) {
  const double scale = unit == "deg/h"   ? 1.0 / 3600.0
                       : unit == "rad/s" ? 180.0 / std::numbers::pi
                                         : 1.0;
  if (scale != 1.0) {
    for (double& value : values) value *= scale;
    unit = kRateUnit;
  }
}

/// Takes the units in brackets out of the names of the columns.
std::vector<std::string> take_units(CsvTable& csv) {
  std::vector<std::string> units;
  for (std::string& cell : csv.names) {
    ColumnName about = column_name(cell);
    cell = std::move(about.name);
    units.push_back(std::move(about.unit));
  }
  return units;
}

Signal csv_signal(const AllanArguments& arguments, std::string_view text) {
  CsvTable csv = parse_csv(text, arguments.file);
  const std::vector<std::string> units = take_units(csv);
  Signal signal;
  std::vector<double> values;
  if (csv.columns.size() == 1 && !arguments.dataset) {
    signal.column = "rate";
    values = csv.columns.front();
  } else {
    signal.column = csv_column(arguments, csv);
    values = csv.column(signal.column);
  }
  const auto named = std::ranges::find(csv.names, signal.column);
  if (named != csv.names.end())
    signal.unit = units[static_cast<std::size_t>(named - csv.names.begin())];
  const bool is_stated = arguments.unit || !signal.unit.empty();
  if (arguments.unit || !is_stated)
    signal.unit = arguments.unit.value_or(kRateUnit);
  if (signal.unit == "degree/s") signal.unit = kRateUnit;
  convert(signal.unit, values);
  signal.recording.time = csv_time(arguments, csv, units);
  signal.recording.status.assign(values.size(), 0);
  signal.recording.columns.push_back(
      {signal.column, signal.unit, "", Role::kMeasured, std::move(values)});
  if (!is_stated)
    signal.warnings.push_back(fmt::format(
        "{}: a CSV states no unit; taken as {}; --unit names another",
        arguments.file, kRateUnit));
  return signal;
}

Signal signal_of_recording(const AllanArguments& arguments,
                           Recording recording) {
  Signal signal;
  signal.recording = std::move(recording);
  signal.column = arguments.dataset.value_or("rate");
  const Column* column = find_column(signal.recording, signal.column);
  if (column != nullptr)
    signal.unit = column->units == "degree/s" ? kRateUnit : column->units;
  if (arguments.unit)
    throw std::invalid_argument(
        fmt::format("--unit {}: is for a CSV only; {} states its unit, {}",
                    *arguments.unit, arguments.file, signal.unit));
  return signal;
}

/// A recording, or else a series in a CSV.
Signal signal_of(const AllanArguments& arguments) {
  if (std::filesystem::path(arguments.file).extension() != ".csv")
    return signal_of_recording(arguments, load_recording(arguments.file));
  const std::string text = read_text_file(arguments.file);
  if (is_recording_csv(text))
    return signal_of_recording(arguments,
                               parse_recording_csv(text, arguments.file));
  return csv_signal(arguments, text);
}

TimeWindow window_of(const AllanArguments& arguments) {
  TimeWindow window;
  window.from = arguments.from.value_or(window.from);
  window.to = arguments.to.value_or(window.to);
  return window;
}

void check_options(const AllanArguments& arguments) {
  const TimeWindow window = window_of(arguments);
  if (!(window.from < window.to))
    throw std::invalid_argument(
        fmt::format("--from {} --to {}: empty; expected --from below --to",
                    window.from, window.to));
}

void check_rate(const AllanArguments& arguments, const EvenSeries& series) {
  if (arguments.rate &&
      std::abs(*arguments.rate * series.interval - 1.0) > kSameRate)
    throw std::invalid_argument(fmt::format(
        "--rate-Hz {}: the times of {} say {:g} Hz; expected no --rate-Hz",
        *arguments.rate, arguments.file, 1.0 / series.interval));
}

nlohmann::ordered_json series_json(const EvenSeries& series,
                                   const Signal& signal) {
  return {{"dataset", signal.column},
          {"unit", signal.unit},
          {"rate_Hz", 1.0 / series.interval},
          {"from_s", series.first},
          {"to_s", series.last},
          {"stretches", series.stretches.size()},
          {"samples", series.samples},
          {"missing", series.missing},
          {"left_out", series.left_out}};
}

/// The kinds asked for, each once.
std::vector<DeviationKind> kinds_asked_for(const AllanArguments& arguments) {
  if (arguments.kinds.empty())
    return {DeviationKind::kAdev, DeviationKind::kOadev};
  std::vector<DeviationKind> kinds;
  for (const std::string& name : arguments.kinds) {
    const DeviationKind kind = deviation_kind(name);
    if (std::ranges::count(kinds, kind) == 0) kinds.push_back(kind);
  }
  return kinds;
}

TauSpacing spacing_of(const AllanArguments& arguments) {
  const auto& names = tau_spacing_names();
  return static_cast<TauSpacing>(std::ranges::find(names, arguments.taus) -
                                 names.begin());
}

/// The overlapping deviation at octaves, to which the coefficients are fitted.
std::vector<AllanPoint> octaves(const EvenSeries& series, TauSpacing spacing,
                                const std::vector<DeviationCurve>& curves) {
  const auto found =
      std::ranges::find(curves, DeviationKind::kOadev, &DeviationCurve::kind);
  if (spacing == TauSpacing::kOctave && found != curves.end())
    return found->points;
  return allan_curve(series, octave_taus(series)).overlapping;
}

int allan(const AllanArguments& arguments) {
  check_options(arguments);
  if (!arguments.json.empty()) {
    require_output(arguments.json, {arguments.file});
    require_json_name(arguments.json);
  }
  std::optional<Progress> progress("Allan deviation of " + arguments.file);
  Signal signal = signal_of(arguments);
  const EvenSeries series =
      even_series(signal.recording, signal.column, window_of(arguments));
  check_rate(arguments, series);
  if (series.missing + series.left_out > 0)
    signal.warnings.push_back(fmt::format(
        "{}: {} of {} samples used; {} missing between them", arguments.file,
        series.samples, series.samples + series.left_out, series.missing));
  const TauSpacing spacing = spacing_of(arguments);
  const std::vector<DeviationCurve> curves = deviation_curves(
      series, kinds_asked_for(arguments), taus_of(series, spacing),
      [&](double share) { progress->set_share(share); });
  std::string text = series_line(series) + deviation_table(curves, signal.unit);
  nlohmann::ordered_json json = to_json(curves);
  json["series"] = series_json(series, signal);
  json["noise"] = nullptr;
  // With fewer points than the coefficients need only the curve is printed.
  const std::vector<AllanPoint> fitted = octaves(series, spacing, curves);
  if (has_noise_coefficients(fitted)) {
    const NoiseCoefficients found = noise_coefficients(fitted);
    text += '\n';
    text += noise_table(found, signal.unit);
    json["noise"] = to_json(found, signal.unit);
  }
  json["warnings"] = signal.warnings;
  progress.reset();
  for (const std::string& warning : signal.warnings) print_warning(warning);
  if (!arguments.json.empty())
    write_text_file(arguments.json, json.dump(2) + "\n");
  print_result(text);
  return 0;
}

}  // namespace

void add_allan(CommandLine& program) {
  auto arguments = std::make_shared<AllanArguments>();
  Command& command =
      program.add("allan", kFiles,
                  "Computes Allan deviations and noise coefficients of a rate");
  command.argument({"FILE", "", "RUN.h5 or SERIES.csv"}, arguments->file);
  command.reads({{FileKind::kRecording},
                 {FileKind::kRecordingTable, FileKind::kCharacteristic,
                  FileKind::kProfile}});
  command.text({"--dataset", "NAME", "Variable or column", "rate"},
               arguments->dataset);
  command.number(
      {"--from", "S", "First time to use, in seconds", "the first sample"},
      arguments->from);
  command.number(
      {"--to", "S", "Last time to use, in seconds", "the last sample"},
      arguments->to);
  command.choices({"--kind", "KIND",
                   "Deviations to compute, between commas or repeated: adev, "
                   "oadev, mdev, hdev, ohdev, totdev",
                   "adev,oadev"},
                  arguments->kinds, deviation_names());
  command.choice({"--taus", "octave|decade|all",
                  "Averaging times: 1, 2, 4, 8 samples and so on; 1, 2, 4, 10, "
                  "20, 40; or 1, 2, 3",
                  "octave"},
                 arguments->taus, tau_spacing_names());
  command.text({"--json", "FILE",
                "Writes the curve, the coefficients and the samples used to "
                "FILE",
                "no file"},
               arguments->json);
  command.group("What a CSV does not state");
  command.number(
      {"--rate-Hz", "F", "Sample rate of a CSV that has no column of times",
       "that of the times"},
      arguments->rate, {0, 1e9, true, true});
  command.text({"--unit", "U",
                "Unit of a CSV: deg/s, deg/h, rad/s, or any other text, which "
                "is printed as it is",
                "deg/s"},
               arguments->unit);
  command.example("beamgyro allan rest.h5", "The rate of a recording");
  command.example("beamgyro allan rest.h5 --kind oadev,mdev --taus decade",
                  "Other deviations");
  command.example("beamgyro allan series.csv --rate-Hz 100 --unit deg/h",
                  "A column of rates without times");
  command.action([arguments] { return allan(*arguments); });
}

}  // namespace beamgyro::internal
