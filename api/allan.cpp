// SPDX-License-Identifier: MIT
#include "include/beamgyro/allan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "api/reported_progress.h"
#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"
#include "config/option_message.h"
#include "config/range.h"
#include "dataset/files/file_ending.h"
#include "dataset/files/json_text.h"
#include "dataset/files/text_file.h"
#include "dataset/log/csv_file.h"
#include "dataset/log/recording_csv.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/units.h"
#include "report/allan_report.h"

namespace beamgyro {
namespace internal {
namespace {

constexpr const char* kRateUnit = "deg/s";
constexpr double kSameRate = 0.01;        // [-], of two sample rates
constexpr Range kSampleRates{1e-9, 1e9};  // [Hz]
constexpr double kMostUneven = 0.05;      // [-], of the steps of a series

/// A file of samples and what is asked of it.
struct AllanQuestion {
  std::string file;  // name in messages
  AllanFileOptions about;
  AllanOptions options;
};

/// The signal whose deviations are computed.
struct AllanSignal {
  Recording recording;  // holds the column
  std::string column, unit;
  std::vector<std::string> warnings;  // of the series
  std::vector<std::string> file_warnings = {};
};

bool is_time(const std::string& name) {
  return name == "time" || name == "time_s";
}

std::string csv_column(const AllanQuestion& asked, const CsvTable& csv) {
  if (asked.about.column) return *asked.about.column;
  std::vector<std::string> signals = csv.names;
  std::erase_if(signals, is_time);
  if (signals.size() == 1) return signals.front();
  if (std::ranges::count(signals, "rate") == 1) return "rate";
  throw option_error("{}: has {} columns; expected {} to choose one",
                     asked.file, csv.columns.size(),
                     NamedOption{"column", "NAME"});
}

/// The same for a signal in memory.
void require_increasing(const std::string& file,
                        const std::vector<double>& time) {
  for (std::size_t k = 0; k < time.size(); ++k)
    if (!std::isfinite(time[k]) || (k > 0 && !(time[k] > time[k - 1])))
      throw std::invalid_argument(fmt::format(
          "{}: time: sample {} is {} s{}; expected times that increase", file,
          k, time[k], k > 0 ? fmt::format(" after {} s", time[k - 1]) : ""));
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
std::vector<double> time_in_seconds(const AllanQuestion& asked,
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
        fmt::format("{}:1: {}: {}", asked.file, name, error.what()));
  }
  require_increasing(csv, time);
  return time;
}

std::vector<double> even_times(std::size_t count, double rate_Hz) {
  std::vector<double> time(count);
  for (std::size_t k = 0; k < count; ++k)
    time[k] = static_cast<double>(k) / rate_Hz;
  return time;
}

std::vector<double> csv_time(const AllanQuestion& asked, const CsvTable& csv,
                             const std::vector<std::string>& units) {
  const auto name = std::ranges::find_if(csv.names, is_time);
  if (name != csv.names.end())
    return time_in_seconds(
        asked, csv, *name,
        units[static_cast<std::size_t>(name - csv.names.begin())]);
  if (!asked.about.rate_Hz)
    throw option_error(
        "{}: a CSV series without a column \"time\" [s] has no sample rate; "
        "expected {}",
        asked.file, NamedOption{"rate_Hz"});
  return even_times(csv.columns.front().size(), *asked.about.rate_Hz);
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

void set_samples(AllanSignal& signal, std::vector<double> time,
                 std::vector<double> values) {
  convert(signal.unit, values);
  signal.recording.time = std::move(time);
  signal.recording.status.assign(values.size(), 0);
  signal.recording.columns.push_back(
      {signal.column, signal.unit, "", Role::kMeasured, std::move(values)});
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

AllanSignal csv_signal(const AllanQuestion& asked, std::string_view text) {
  CsvTable csv = parse_csv(text, asked.file);
  const std::vector<std::string> units = take_units(csv);
  AllanSignal signal;
  std::vector<double> values;
  if (csv.columns.size() == 1 && !asked.about.column) {
    signal.column = "rate";
    values = csv.columns.front();
  } else {
    signal.column = csv_column(asked, csv);
    values = csv.column(signal.column);
  }
  const auto named = std::ranges::find(csv.names, signal.column);
  if (named != csv.names.end())
    signal.unit = units[static_cast<std::size_t>(named - csv.names.begin())];
  const bool is_stated = asked.about.unit || !signal.unit.empty();
  if (asked.about.unit || !is_stated)
    signal.unit = asked.about.unit.value_or(kRateUnit);
  if (signal.unit == "degree/s") signal.unit = kRateUnit;
  set_samples(signal, csv_time(asked, csv, units), std::move(values));
  if (!is_stated)
    signal.warnings.push_back(fmt::format(
        "{}: a CSV states no unit; taken as {}, since none is given",
        asked.file, kRateUnit));
  return signal;
}

AllanSignal signal_of_recording(const AllanQuestion& asked,
                                Recording recording) {
  AllanSignal signal;
  signal.recording = std::move(recording);
  signal.column = asked.about.column.value_or("rate");
  const Column* column = find_column(signal.recording, signal.column);
  if (column != nullptr)
    signal.unit = column->units == "degree/s" ? kRateUnit : column->units;
  if (asked.about.unit)
    throw option_error("{}: is for a CSV only; {} states its unit, {}",
                       NamedOption{"unit", *asked.about.unit}, asked.file,
                       signal.unit);
  return signal;
}

AllanSignal signal_of(const AllanQuestion& asked) {
  if (file_ending(asked.file) != ".csv") {
    std::vector<std::string> warnings;
    AllanSignal signal = signal_of_recording(
        asked, beamgyro::read_recording(asked.file, &warnings));
    signal.file_warnings = std::move(warnings);
    return signal;
  }
  const std::string text = read_text_file(asked.file);
  if (is_recording_csv(text))
    return signal_of_recording(asked, parse_recording_csv(text, asked.file));
  return csv_signal(asked, text);
}

TimeWindow window_of(const AllanOptions& options) {
  if (!(options.from_s < options.to_s))
    throw option_error("{} {}: empty; expected {} below {}",
                       NamedOption{"from_s", fmt::to_string(options.from_s)},
                       NamedOption{"to_s", fmt::to_string(options.to_s)},
                       NamedOption{"from_s"}, NamedOption{"to_s"});
  return {options.from_s, options.to_s};
}

void check_rate(const AllanQuestion& asked, const EvenSeries& series) {
  if (asked.about.rate_Hz &&
      std::abs(*asked.about.rate_Hz * series.interval - 1.0) > kSameRate)
    throw option_error(
        "{}: the times of {} say {:g} Hz; expected no {}",
        NamedOption{"rate_Hz", fmt::to_string(*asked.about.rate_Hz)},
        asked.file, 1.0 / series.interval, NamedOption{"rate_Hz"});
}

void require_even(const AllanQuestion& asked, const EvenSeries& series) {
  if (series.unevenness > kMostUneven)
    throw std::invalid_argument(fmt::format(
        "{}: time: 64 samples span {:.0f} % more or less than 64 steps of "
        "{:g} s; expected even times, with or without gaps",
        asked.file, 100.0 * series.unevenness, series.interval));
}

nlohmann::ordered_json series_json(const EvenSeries& series,
                                   const AllanSignal& signal) {
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
std::vector<DeviationKind> kinds_asked_for(const AllanQuestion& asked) {
  if (asked.options.kinds.empty())
    return {DeviationKind::kAdev, DeviationKind::kOadev};
  std::vector<DeviationKind> kinds;
  for (const std::string& name : asked.options.kinds) {
    const DeviationKind kind = deviation_kind(name);
    if (std::ranges::count(kinds, kind) == 0) kinds.push_back(kind);
  }
  return kinds;
}

TauSpacing spacing_of(const AllanQuestion& asked) {
  const auto& names = tau_spacing_names();
  const auto found = std::ranges::find(names, asked.options.taus);
  if (found == names.end())
    throw std::invalid_argument(fmt::format("taus \"{}\"; expected {}",
                                            asked.options.taus,
                                            fmt::join(names, ", ")));
  return static_cast<TauSpacing>(found - names.begin());
}

/// The overlapping deviation at octaves, to which the coefficients are fitted.
std::vector<AllanPoint> octaves(const EvenSeries& series, TauSpacing spacing,
                                const std::vector<DeviationSeries>& curves) {
  const auto found =
      std::ranges::find(curves, DeviationKind::kOadev, &DeviationSeries::kind);
  if (spacing == TauSpacing::kOctave && found != curves.end())
    return found->points;
  return allan_curve(series, octave_taus(series)).overlapping;
}

void add_curves(const std::vector<DeviationSeries>& curves,
                AllanResult& result) {
  for (const DeviationSeries& curve : curves) {
    DeviationCurve shown{name_of(curve.kind), {}};
    for (const AllanPoint& point : curve.points)
      shown.points.push_back({point.tau, point.deviation, point.interval.low,
                              point.interval.high, point.clusters});
    result.curves.push_back(std::move(shown));
  }
}

void add_coefficients(const NoiseCoefficients& found, AllanResult& result) {
  for (const CoefficientReport& report : reports(found, result.unit)) {
    if (!report.per_second) continue;
    const CoefficientEstimate& estimate = *report.per_second;
    result.coefficients.push_back(
        {report.symbol, report.name, estimate.value, estimate.interval.low,
         estimate.interval.high, report.unit_per_second,
         estimate.value * report.hours_per_second_unit, report.unit_per_hour});
  }
}

// Without them a curve of what is beside the samples would come out.
void require_complete(const AllanQuestion& asked, const AllanSignal& signal) {
  const Recording& recording = signal.recording;
  const std::size_t times = recording.time.size();
  const Column* column = find_column(recording, signal.column);
  if (recording.status.size() != times ||
      (column != nullptr && column->values.size() != times))
    throw std::invalid_argument(fmt::format(
        "{}: {} times, {} values of status and {} of {}; expected as many of "
        "each",
        asked.file, times, recording.status.size(),
        column != nullptr ? column->values.size() : 0, signal.column));
  if (column == nullptr) return;
  for (std::size_t k = 0; k < times; ++k)
    if (std::abs(column->values[k]) > kLargestValue)
      throw std::invalid_argument(fmt::format(
          "{}: {}: sample {} is {:g}; expected at most +-{:g}", asked.file,
          signal.column, k, column->values[k], kLargestValue));
}

AllanResult result_of(const AllanQuestion& asked, AllanSignal signal) {
  require_complete(asked, signal);
  require_increasing(asked.file, signal.recording.time);
  const EvenSeries series =
      even_series(signal.recording, signal.column, window_of(asked.options));
  check_rate(asked, series);
  require_even(asked, series);
  if (series.missing + series.left_out > 0)
    signal.warnings.push_back(fmt::format(
        "{}: {} of {} samples used; {} missing between them", asked.file,
        series.samples, series.samples + series.left_out, series.missing));
  const TauSpacing spacing = spacing_of(asked);
  const std::vector<DeviationSeries> curves = deviation_curves(
      series, kinds_asked_for(asked), taus_of(series, spacing),
      [&](double share) { report(asked.options.progress, share); });
  AllanResult result;
  result.unit = signal.unit;
  add_curves(curves, result);
  result.text = series_line(series) + deviation_table(curves, signal.unit);
  nlohmann::ordered_json json = to_json(curves);
  json["series"] = series_json(series, signal);
  json["noise"] = nullptr;
  // With fewer points than the coefficients need only the curve is printed.
  const std::vector<AllanPoint> fitted = octaves(series, spacing, curves);
  if (has_noise_coefficients(fitted)) {
    const NoiseCoefficients found = noise_coefficients(fitted);
    result.text += '\n';
    result.text += noise_table(found, signal.unit);
    json["noise"] = to_json(found, signal.unit);
    add_coefficients(found, result);
  }
  json["warnings"] = signal.warnings;
  result.json = json_text(json);
  result.warnings = std::move(signal.warnings);
  result.warnings.insert(result.warnings.end(), signal.file_warnings.begin(),
                         signal.file_warnings.end());
  return result;
}

}  // namespace
}  // namespace internal

AllanResult allan(const Recording& recording, const std::string& column,
                  const AllanOptions& options) {
  const internal::AllanQuestion asked{
      "the recording", {.column = column}, options};
  return internal::result_of(asked,
                             internal::signal_of_recording(asked, recording));
}

AllanResult allan(std::span<const double> samples, double rate_Hz,
                  const std::string& unit, const AllanOptions& options) {
  if (!internal::kSampleRates.contains(rate_Hz))
    throw std::invalid_argument(
        fmt::format("{} samples a second; expected {:g} to {:g}", rate_Hz,
                    internal::kSampleRates.low, internal::kSampleRates.high));
  const internal::AllanQuestion asked{"the series", {}, options};
  internal::AllanSignal signal;
  signal.column = "rate";
  signal.unit = unit;
  internal::set_samples(signal, internal::even_times(samples.size(), rate_Hz),
                        {samples.begin(), samples.end()});
  return internal::result_of(asked, std::move(signal));
}

AllanResult allan_of_file(const std::filesystem::path& file,
                          const AllanFileOptions& about,
                          const AllanOptions& options) {
  const internal::AllanQuestion asked{file.string(), about, options};
  internal::window_of(options);  // throws before a long file is read
  return internal::result_of(asked, internal::signal_of(asked));
}

}  // namespace beamgyro
