// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "compensation/scoring/scale_factor.h"
#include "validation/page/figure_makers.h"
#include "validation/page/residual_means.h"

namespace beamgyro {
namespace {

constexpr double kMillion = 1e6;      // [ppm]
constexpr double kOtherTable = 3.0;   // [K], between two rate tables
constexpr double kLongestHold = 5.0;  // [-], of the median; longer: warm-up
constexpr double kNormal95 = 1.96;    // [-]
constexpr double kBeforeStep = 0.02;  // [s]
constexpr double kAfterStep = 0.1;    // [s]
constexpr double kSamplesAfterStep = 50.0;

/// A rate that was held, and the answer to it.
struct TableHold {
  double begin, end;                               // [s]
  double rate;                                     // [deg/s], true
  double temperature;                              // [degC]
  double sum = 0.0, squares = 0.0, samples = 0.0;  // of the answer less rate
};

/// A table of rates at one temperature.
struct TableAtTemperature {
  double temperature = 0.0;  // [degC]
  std::map<double, TableHold> holds = {};
};

std::vector<TableHold> table_holds(const EvidenceRun& run) {
  const Recording& recording = *run.recording;
  const auto& truth = column_values(recording, "true_rate");
  const auto& temperature = column_values(recording, "temperature");
  const std::vector<double> residual = residuals(run);
  std::vector<TableHold> holds;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const double time = recording.time[k];
    if (holds.empty() || truth[k] != holds.back().rate)
      holds.push_back({time, time, truth[k], temperature[k]});
    TableHold& hold = holds.back();
    hold.end = time;
    if (!std::isfinite(residual[k]) || time - hold.begin < kSettlingTime ||
        (recording.status[k] & kOutputSaturated) != 0)
      continue;
    hold.temperature = temperature[k];
    hold.sum += residual[k];
    hold.squares += residual[k] * residual[k];
    hold.samples += 1.0;
  }
  std::erase_if(holds,
                [](const TableHold& hold) { return hold.samples < 1.0; });
  return holds;
}

/// The tables of a run: holds that are no warm-up, those of one rate together.
std::vector<TableAtTemperature> tables_of(const EvidenceRun& run) {
  std::vector<TableHold> holds = table_holds(run);
  if (holds.empty()) return {};
  std::vector<double> lengths;
  for (const TableHold& hold : holds) lengths.push_back(hold.end - hold.begin);
  std::ranges::nth_element(
      lengths, lengths.begin() + static_cast<long>(lengths.size() / 2));
  const double longest = kLongestHold * lengths[lengths.size() / 2];
  std::vector<TableAtTemperature> tables;
  for (const TableHold& hold : holds) {
    if (hold.end - hold.begin > longest) continue;
    if (tables.empty() ||
        std::abs(hold.temperature - tables.back().temperature) > kOtherTable)
      tables.push_back({hold.temperature});
    auto [entry, is_new] = tables.back().holds.try_emplace(hold.rate, hold);
    if (is_new) continue;
    entry->second.sum += hold.sum;
    entry->second.squares += hold.squares;
    entry->second.samples += hold.samples;
  }
  std::erase_if(tables, [](const TableAtTemperature& table) {
    return table.holds.size() < 3;
  });
  return tables;
}

/// What a table says of the scale factor.
struct TableLine {
  double offset = 0.0;         // [deg/s]
  double slope = 0.0;          // [-], of answer less rate over rate
  double largest = 0.0;        // [deg/s], rate
  double half_interval = 0.0;  // [-], 95 %, of the slope, from the departures
};

TableLine table_line(const TableAtTemperature& table) {
  const auto n = static_cast<double>(table.holds.size());
  double rate = 0.0, answer = 0.0, squares = 0.0, product = 0.0, left = 0.0;
  TableLine line;
  for (const auto& [held, hold] : table.holds) {
    rate += held / n;
    answer += hold.sum / hold.samples / n;
    line.largest = std::max(line.largest, std::abs(held));
  }
  for (const auto& [held, hold] : table.holds) {
    squares += (held - rate) * (held - rate);
    product += (held - rate) * (hold.sum / hold.samples - answer);
  }
  line.slope = product / squares;
  line.offset = answer - line.slope * rate;
  for (const auto& [held, hold] : table.holds) {
    const double departure =
        hold.sum / hold.samples - line.offset - line.slope * held;
    left += departure * departure;
  }
  line.half_interval = kNormal95 * std::sqrt(left / (n - 2.0) / squares);
  return line;
}

/// Departures of a table from its line.
FigureSeries departures(const TableAtTemperature& table, const TableLine& line,
                        const std::string& role) {
  FigureSeries series{fmt::format("{:.0f} degC", table.temperature), role};
  const double unit = kMillion / ((1.0 + line.slope) * line.largest);
  for (const auto& [held, hold] : table.holds) {
    const double mean = hold.sum / hold.samples;
    const double variance =
        std::max(0.0, hold.squares / hold.samples - mean * mean);
    series.add(held, unit * (mean - line.offset - line.slope * held),
               unit * kNormal95 * std::sqrt(variance / hold.samples));
  }
  return series;
}

/// Frequency of a sine [rad/s] at equal steps, about any mean; nothing for a
/// signal that is none.
std::optional<double> sine_frequency(const std::vector<double>& time,
                                     const std::vector<double>& signal) {
  double product = 0.0, squares = 0.0;
  for (std::size_t k = 3; k < signal.size(); ++k) {
    const double before = signal[k - 2] - signal[k - 3];
    const double here = signal[k - 1] - signal[k - 2];
    product += here * (before + signal[k] - signal[k - 1]);
    squares += here * here;
  }
  const double cosine = 0.5 * product / squares;
  if (!(std::abs(cosine) < 1.0)) return std::nullopt;
  return std::acos(cosine) / (time[1] - time[0]);
}

/// Amplitude of e^(i omega t) in the second half of a signal, beside a straight
/// line.
std::complex<double> sine_amplitude(const std::vector<double>& time,
                                    const std::vector<double>& signal,
                                    double omega) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  const double middle = time[time.size() / 2];
  const double half = time.back() - middle;
  for (std::size_t k = time.size() / 2; k < time.size(); ++k) {
    if (!std::isfinite(signal[k])) continue;
    const double phase = omega * (time[k] - middle);
    const Eigen::Vector4d row(1.0, (time[k] - middle) / half, std::cos(phase),
                              std::sin(phase));
    normal += row * row.transpose();
    right += signal[k] * row;
  }
  const Eigen::Vector4d fitted = normal.ldlt().solve(right);
  return {fitted[2], -fitted[3]};
}

/// Start of the largest step of the true rate: the first sample after it.
std::size_t largest_step(const std::vector<double>& truth) {
  std::size_t found = 0;
  double largest = 0.0;
  for (std::size_t k = 1; k < truth.size(); ++k)
    if (std::abs(truth[k] - truth[k - 1]) > largest) {
      largest = std::abs(truth[k] - truth[k - 1]);
      found = k;
    }
  return found;
}

/// A signal around the step at sample `step`, over milliseconds since it.
FigureSeries around_step(const std::string& name, const std::string& role,
                         const std::vector<double>& time,
                         const std::vector<double>& signal, std::size_t step) {
  FigureSeries series{name, role};
  const double interval = time[step] - time[step - 1];
  const double after = std::max(kAfterStep, kSamplesAfterStep * interval);
  const double before = std::max(kBeforeStep, 0.2 * after);
  for (std::size_t k = 0; k < time.size(); ++k)
    if (time[k] >= time[step] - before && time[k] <= time[step] + after)
      series.add(1e3 * (time[k] - time[step]), signal[k]);
  return series;
}

}  // namespace

std::vector<Figure> rate_table_figures(const ComparedEvidence& both) {
  const char* caption =
      "Departure of each held rate from the straight line through the table of "
      "its temperature, in parts per million of the largest rate. Whiskers: "
      "noise, 95 %.";
  const FigureAxis rate{"True rate", "deg/s"};
  const FigureAxis departure{"Departure from the line", "ppm"};
  Figure before{"rate_table_before",
                "Rate-table residuals, before compensation", caption, rate,
                departure};
  Figure after{"rate_table_after", "Rate-table residuals, after compensation",
               caption, rate, departure};
  Figure slope{"scale_factor_over_temperature",
               "Scale factor over temperature",
               "Slope of each rate table, less one. Whiskers: 95 %, from the "
               "departures from the line.",
               temperature_axis(),
               {"Scale factor error", "ppm"}};
  FigureSeries slopes[2] = {{"before", "before"}, {"after", "after"}};
  for_both(
      both, RunPurpose::kRateTable,
      [&](const std::string& role, const EvidenceRun& run) {
        for (const TableAtTemperature& table : tables_of(run)) {
          const TableLine line = table_line(table);
          (role == "after" ? after : before).add(departures(table, line, role));
          slopes[role == "after"].add(table.temperature, kMillion * line.slope,
                                      kMillion * line.half_interval);
        }
      });
  for (FigureSeries& series : slopes) slope.add(std::move(series));
  return {std::move(before), std::move(after), std::move(slope)};
}

std::vector<Figure> frequency_response_figures(const ComparedEvidence& both) {
  Figure gain{"frequency_response_gain",
              "Frequency response: gain",
              "Amplitude of the answer to sine rates over that of the rate.",
              {"Frequency", "Hz", true},
              {"Gain", "dB"}};
  Figure phase{"frequency_response_phase",
               "Frequency response: phase",
               "Phase of the answer to sine rates against the rate.",
               {"Frequency", "Hz", true},
               {"Phase", "deg"}};
  std::map<std::string, std::map<double, std::complex<double>>> responses;
  for_both(both, RunPurpose::kSineRate,
           [&](const std::string& role, const EvidenceRun& run) {
             const auto& time = run.recording->time;
             const auto& truth = column_values(*run.recording, "true_rate");
             const auto omega = sine_frequency(time, truth);
             if (!omega) return;
             responses[role][*omega / (2.0 * std::numbers::pi)] =
                 sine_amplitude(time, run.rate, *omega) /
                 sine_amplitude(time, truth, *omega);
           });
  for (const std::string role : {"before", "after"}) {
    FigureSeries gains{role, role}, phases{role, role};
    for (const auto& [frequency, response] : responses[role]) {
      gains.add(frequency, 20.0 * std::log10(std::abs(response)));
      phases.add(frequency, std::arg(response) * 180.0 / std::numbers::pi);
    }
    gain.add(std::move(gains));
    phase.add(std::move(phases));
  }
  return {std::move(gain), std::move(phase)};
}

std::vector<Figure> rate_step_figures(const ComparedEvidence& both) {
  Figure figure{"rate_step",
                "Answer to a step of the rate",
                "A compensator that adds delay answers later than the gyro "
                "alone.",
                {"Time since the step", "ms"},
                {"Rate", "deg/s"}};
  std::optional<FigureSeries> true_rate;
  for_both(both, RunPurpose::kRateStep,
           [&](const std::string& role, const EvidenceRun& run) {
             const auto& time = run.recording->time;
             const auto& truth = column_values(*run.recording, "true_rate");
             const std::size_t step = largest_step(truth);
             if (step == 0) return;
             if (!true_rate)
               true_rate = around_step("true rate", "fit", time, truth, step);
             figure.add(around_step(role, role, time, run.rate, step));
           });
  if (true_rate) figure.add(*std::move(true_rate));
  return {std::move(figure)};
}

}  // namespace beamgyro
