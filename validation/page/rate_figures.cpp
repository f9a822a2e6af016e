// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "compensation/scoring/scale_factor.h"
#include "validation/metrics/frequency_response.h"
#include "validation/metrics/noisy_means.h"
#include "validation/metrics/segments.h"
#include "validation/page/figure_makers.h"

namespace beamgyro::internal {
namespace {

constexpr double kMillion = 1e6;      // [ppm]
constexpr double kOtherTable = 3.0;   // [K], between two rate tables
constexpr double kLongestHold = 5.0;  // [-], of the median; longer: warm-up
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kLeastGain = 0.01;   // [-], -40 dB
constexpr double kBeforeStep = 0.02;  // [s]
constexpr double kAfterStep = 0.1;    // [s]
constexpr double kSamplesAfterStep = 50.0;

/// A rate that was held, and what was answered beside it.
struct TableHold {
  double rate;                                     // [deg/s], true
  double seconds;                                  // [s], for how long
  double temperature;                              // [degC]
  double sum = 0.0, squares = 0.0, samples = 0.0;  // of the residual
};

/// A table of rates at one temperature.
struct TableAtTemperature {
  double temperature = 0.0;  // [degC]
  std::map<double, TableHold> holds = {};
};

std::vector<TableHold> table_holds(const EvidenceRun& run) {
  const Recording& recording = *run.recording;
  const auto& truth = column_values(recording, "true_rate");
  const std::vector<double> residual = residual_of(run);
  std::vector<SampleRange> ranges;
  for (const SampleRange& held : held_ranges(recording, std::array{&truth}))
    if (const SampleRange range = settled(recording, held, kSettlingTime);
        range.size() > 0)
      ranges.push_back(range);
  std::vector<TableHold> holds;
  for (const Segment& segment : segments_of(recording, ranges)) {
    TableHold hold{truth[segment.samples.begin], segment.length,
                   segment.temperature};
    for (std::size_t k = segment.samples.begin; k < segment.samples.end; ++k) {
      if (!std::isfinite(residual[k]) ||
          (recording.status[k] & kOutputSaturated) != 0)
        continue;
      hold.sum += residual[k];
      hold.squares += residual[k] * residual[k];
      hold.samples += 1.0;
    }
    if (hold.samples > 0.0) holds.push_back(hold);
  }
  return holds;
}

/// The tables of a run: holds that are no warm-up, those of one rate together.
std::vector<TableAtTemperature> tables_of(const EvidenceRun& run) {
  std::vector<TableHold> holds = table_holds(run);
  if (holds.empty()) return {};
  std::vector<double> lengths;
  for (const TableHold& hold : holds) lengths.push_back(hold.seconds);
  std::ranges::nth_element(
      lengths, lengths.begin() + static_cast<long>(lengths.size() / 2));
  const double longest = kLongestHold * lengths[lengths.size() / 2];
  std::vector<TableAtTemperature> tables;
  for (const TableHold& hold : holds) {
    if (hold.seconds > longest) continue;
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
  line.half_interval = kNormal975 * std::sqrt(left / (n - 2.0) / squares);
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
               unit * kNormal975 * std::sqrt(variance / hold.samples));
  }
  return series;
}

/// Gain and phase of one rate.
struct ResponseCurves {
  FigureSeries gain, phase;
};

ResponseCurves response_curves(const Evidence& evidence,
                               const std::string& role) {
  ResponseCurves curves{{role, role}, {role, role}};
  double last = 0.0;  // [rad], of the phase
  for (const ResponsePoint& point : response_to_true_rate(evidence)) {
    const double size = std::abs(point.gain);
    const double half = kNormal975 * point.sigma / size;  // [-], [rad]
    if (size < kLeastGain) break;  // noise and resolution from there on
    // The phase goes on from that of the frequency before.
    const double turn = 2.0 * std::numbers::pi;
    const double phase = std::arg(point.gain);
    last = phase + turn * std::round((last - phase) / turn);
    curves.gain.add(point.frequency, 20.0 * std::log10(size),
                    20.0 * std::numbers::log10e * half);
    curves.phase.add(point.frequency, kDegreesPerRadian * last,
                     kDegreesPerRadian * half);
  }
  return curves;
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
  Figure gain{
      "frequency_response_gain",
      "Frequency response: gain",
      "Amplitude of the judged rate over that of the true rate: from sine "
      "rates, and above the highest of them from a step, down to -40 dB.",
      {"Frequency", "Hz", true},
      {"Gain", "dB"}};
  Figure phase{
      "frequency_response_phase",
      "Frequency response: phase",
      "Phase of the judged rate against the true rate, of the same runs.",
      {"Frequency", "Hz", true},
      {"Phase", "deg"}};
  for (const auto& [role, evidence] :
       {std::pair("before", &both.before), std::pair("after", &both.after)}) {
    ResponseCurves curves = response_curves(*evidence, role);
    gain.add(std::move(curves.gain));
    phase.add(std::move(curves.phase));
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

}  // namespace beamgyro::internal
