// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "compensation/allan_deviation.h"
#include "compensation/noise_coefficients.h"
#include "dataset/atomic_file.h"
#include "dataset/csv_file.h"
#include "dataset/hdf5_file.h"

namespace beamgyro {
namespace {

struct AllanArguments {
  std::string file, json;
  std::optional<std::string> dataset;
  std::optional<double> rate;
};

GaplessSeries csv_series(const AllanArguments& arguments) {
  if (!arguments.rate) {
    throw std::invalid_argument(
        fmt::format("{}: a CSV series has no sample rate; expected --rate-Hz",
                    arguments.file));
  }
  const CsvTable csv = read_csv(arguments.file);
  GaplessSeries series;
  series.interval = 1 / *arguments.rate;
  if (arguments.dataset) {
    series.rates = csv.column(*arguments.dataset);
  } else if (csv.columns.size() == 1) {
    series.rates = csv.columns.front();
  } else {
    throw std::invalid_argument(
        fmt::format("{}: has {} columns; expected --dataset NAME to choose one",
                    arguments.file, csv.columns.size()));
  }
  return series;
}

GaplessSeries series_of(const AllanArguments& arguments) {
  if (arguments.rate && !(*arguments.rate > 0 && *arguments.rate < 1e9)) {
    throw std::invalid_argument(fmt::format(
        "--rate-Hz {}: out of range; expected a number > 0", *arguments.rate));
  }
  if (std::filesystem::path(arguments.file).extension() == ".csv")
    return csv_series(arguments);
  GaplessSeries series = longest_gapless_series(
      read_recording(arguments.file), arguments.dataset.value_or("rate"));
  if (arguments.rate) {
    throw std::invalid_argument(
        fmt::format("--rate-Hz {}: the recording says {:g} Hz itself; expected "
                    "no --rate-Hz",
                    *arguments.rate, 1 / series.interval));
  }
  return series;
}

constexpr const char* kRateUnit = "deg/s";

// Unit of the series; a CSV series is one of rates.
std::string unit_of(const AllanArguments& arguments) {
  if (std::filesystem::path(arguments.file).extension() == ".csv")
    return kRateUnit;
  const Recording recording = read_recording(arguments.file);
  const Column* column =
      find_column(recording, arguments.dataset.value_or("rate"));
  if (column == nullptr || column->units == "degree/s") return kRateUnit;
  return column->units;
}

std::string allan_table(const std::vector<AllanPoint>& plain,
                        const std::vector<AllanPoint>& overlapping,
                        const std::string& unit) {
  std::string text =
      fmt::format("{:>12} {:>14} {:>14} {:>10} {:>8}\n", "tau s",
                  "adev " + unit, "oadev " + unit, "clusters", "+-%");
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const bool known = plain[i].clusters > 1;
    fmt::format_to(
        std::back_inserter(text),
        "{:>12.6g} {:>14.6g} {:>14.6g} {:>10} {:>8}\n", plain[i].tau,
        plain[i].deviation, overlapping[i].deviation, plain[i].clusters,
        known ? fmt::format("{:.1f}", 100 * relative_uncertainty(plain[i]))
              : "-");
  }
  return text;
}

int allan(const AllanArguments& arguments) {
  const GaplessSeries series = series_of(arguments);
  if (!arguments.json.empty()) require_output(arguments.json, {arguments.file});
  const std::vector<double> taus =
      octave_taus(series.rates.size(), series.interval);
  const std::vector<AllanPoint> plain =
      adev(series.rates, series.interval, taus);
  const std::vector<AllanPoint> overlapping =
      oadev(series.rates, series.interval, taus);
  if (series.left_out > 0) {
    print_warning(fmt::format(
        "{}: {} samples left out; the longest gapless powered stretch has {}",
        arguments.file, series.left_out, series.rates.size()));
  }
  const std::string unit = unit_of(arguments);
  std::string text = allan_table(plain, overlapping, unit);
  // Fewer points than the coefficients need leave the curve itself, and only
  // those of a rate have names.
  if (unit == kRateUnit && has_noise_coefficients(overlapping)) {
    text += '\n';
    text += table(noise_coefficients(overlapping));
  }
  if (!arguments.json.empty()) {
    write_text_file(arguments.json, to_json(plain, overlapping).dump(2) + "\n");
  }
  print_result(text);
  return 0;
}

}  // namespace

void add_allan(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<AllanArguments>();
  CLI::App* command = program.add_subcommand(
      "allan", "Allan deviation, plain and overlapping, of a rate series");
  command->add_option("file", arguments->file, "RUN.h5 or SERIES.csv")
      ->required();
  command->add_option("--dataset", arguments->dataset,
                      "NAME of the variable or column; rate by default");
  command->add_option("--rate-Hz", arguments->rate, "sample rate of a CSV");
  command->add_option("--json", arguments->json, "FILE for the curve");
  command->callback([arguments, &action] {
    action = [arguments] { return allan(*arguments); };
  });
}

}  // namespace beamgyro
