// SPDX-License-Identifier: MIT
#include "report/recording_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "dataset/log/log_statistics.h"

namespace beamgyro::internal {
namespace {

std::string status_words(const Recording& recording) {
  const auto samples = [&](StatusBit bit) {
    return std::ranges::count_if(
        recording.status, [bit](unsigned status) { return status & bit; });
  };
  return fmt::format("{} unpowered, {} saturated, {} not locked",
                     samples(kUnpowered), samples(kOutputSaturated),
                     samples(kLoopNotLocked));
}

std::string rows_text(const LogCounts& counts) {
  std::string text =
      fmt::format("{} rows read, {} kept\n", counts.rows, counts.kept);
  for (std::size_t i = 0; i < kDropReasons; ++i) {
    const DroppedRows& dropped = counts.dropped[i];
    if (dropped.rows == 0) continue;
    fmt::format_to(std::back_inserter(text),
                   "dropped      {} {}, the first in line {}\n", dropped.rows,
                   reason_name(static_cast<DropReason>(i)), dropped.first_line);
  }
  return text;
}

// What a clock that is coarser than the rows looks like.
std::string counts_text(const LogCounts& counts) {
  const DroppedRows& equal =
      counts.dropped[static_cast<std::size_t>(DropReason::kDuplicate)];
  if (equal.rows <= counts.kept) return {};
  return "question     is the clock of the log coarser than its rows? [time] "
         "with rate_Hz and no column counts the rows\n";
}

// What a signal that is logged at a lower rate looks like.
std::string blank_text(const LogCounts& counts, const std::string& path) {
  if (!counts.is_mostly_blank()) return {};
  return fmt::format(
      "question     is the {0} logged at a lower rate? it is missing in {1} "
      "rows; [join] with its table and --join {2} interpolate it in the same "
      "log\n",
      counts.most_blank.signal, counts.most_blank.rows, path);
}

// A gyro's loop and its filters are slower than this rate of samples.
constexpr double kFastestSampling = 50e3;  // [Hz]

constexpr double kLongLog = 60 * 86400;  // [s]
constexpr double kSlowSampling = 600;    // [s] between two rows
constexpr double kLargestRest = 30;      // [deg/s] of a gyro at rest
constexpr double kLongHold = 600;        // [s]

std::string long_log_text(const Recording& recording, double median_step) {
  const double duration = recording.time.back() - recording.time.front();
  if (duration < kLongLog || median_step < kSlowSampling) return {};
  return fmt::format(
      "question     is that right? {:.3g} days with a row each {:g} s often "
      "mean a wrong time.unit\n",
      duration / 86400, median_step);
}

// The values between which nine of ten finite ones lie.
std::array<double, 2> most_values(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {0.0, 0.0};
  std::ranges::sort(values);
  const std::size_t cut = values.size() / 20;
  return {values[cut], values[values.size() - 1 - cut]};
}

// What no gyro at rest shows.
std::string rest_text(const Recording& recording) {
  const Column* const truth = find_column(recording, "true_rate");
  const bool is_at_rest =
      truth != nullptr && std::ranges::all_of(truth->values, [](double rate) {
        return rate == 0.0;
      });
  if (!is_at_rest) return {};
  const auto [low, high] = most_values(column_values(recording, "rate"));
  if (std::max(-low, high) > kLargestRest)
    return fmt::format(
        "question     can this gyro at rest read {:.4g} to {:.4g} deg/s? more "
        "than {:g} deg/s often mean swapped columns, or a wrong offset, scale "
        "or unit in [gyro]\n",
        low, high, kLargestRest);
  if (low == high && range_of(recording, "rate").smallest_step == 0)
    return "question     is the gyro connected? its rate never changes\n";
  return {};
}

std::string stuck_text(const Recording& recording) {
  const ValueRange range = range_of(recording, "temperature");
  if (range.samples == 0 || range.smallest_step != 0 ||
      recording.time.back() - recording.time.front() < kLongHold)
    return {};
  return "question     does the temperature sensor work? its value never "
         "changes\n";
}

std::string sampling_text(const Recording& recording) {
  const Sampling sampling = sampling_of(recording);
  std::string text = fmt::format(
      "time         {:g} to {:g} s\n"
      "sampling     median step {:.6g} s ({:.6g} Hz), jitter {:.3g} s rms\n",
      recording.time.front(), recording.time.back(), sampling.median_step,
      1 / sampling.median_step, sampling.jitter);
  if (sampling.median_step * kFastestSampling < 1) {
    fmt::format_to(std::back_inserter(text),
                   "question     is that right? more than {:g} Hz often means "
                   "a wrong time.unit\n",
                   kFastestSampling);
  }
  text += long_log_text(recording, sampling.median_step);
  if (sampling.bursts > 1) {
    fmt::format_to(std::back_inserter(text),
                   "bursts       {}, the longest {:g} s; {} gap{}, the longest "
                   "{:g} s\n",
                   sampling.bursts, sampling.longest_burst, sampling.bursts - 1,
                   sampling.bursts == 2 ? "" : "s", sampling.longest_gap);
  }
  return text;
}

std::string range_text(const Recording& recording, const char* column,
                       const char* unit) {
  const ValueRange range = range_of(recording, column);
  if (range.samples == 0)
    return fmt::format("{:<12} unpowered throughout\n", column);
  if (range.smallest_step == 0)
    return fmt::format("{:<12} {:.6g} {} throughout\n", column, range.low,
                       unit);
  return fmt::format("{:<12} {:.6g} to {:.6g} {}, smallest step {:.3g}\n",
                     column, range.low, range.high, unit, range.smallest_step);
}

// The line of its history that says that values were changed, if there is one.
std::string_view history_of_change(const Recording& recording) {
  const std::string_view history = recording.history;
  const std::size_t found = history.find("changed after ");
  if (found == std::string_view::npos) return {};
  const std::size_t newline = history.rfind('\n', found);
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  return history.substr(begin, history.find('\n', found) - begin);
}

}  // namespace

std::string recording_report(const std::string& path,
                             const Recording& recording) {
  std::string text;
  auto out = std::back_inserter(text);
  const std::size_t count = recording.time.size();
  fmt::format_to(out, "{}: recording, {} samples", path, count);
  if (count > 0) {
    fmt::format_to(out, " from {:g} to {:g} s", recording.time.front(),
                   recording.time.back());
  }
  if (count > 1) {
    fmt::format_to(out, ", {:.6g} Hz",
                   static_cast<double>(count - 1) /
                       (recording.time.back() - recording.time.front()));
  }
  fmt::format_to(out, "\nfidelity {}, seed {}, made by beamgyro {} ({})\n",
                 recording.fidelity, recording.seed, recording.program_version,
                 recording.git_revision);
  if (const std::string_view line = history_of_change(recording); !line.empty())
    fmt::format_to(out, "{}\n", line);
  if (!recording.compensator.empty())
    fmt::format_to(out, "compensated by {} (SHA-256 {})\n",
                   recording.compensator, recording.compensator_sha256);
  fmt::format_to(out, "samples {}\n", status_words(recording));
  if (!recording.overrides_text.empty())
    fmt::format_to(out, "overrides\n{}", recording.overrides_text);
  fmt::format_to(out, "\n{:<26} {:<10} {:<12} {:>12} {:>12}\n", "variable",
                 "units", "role", "minimum", "maximum");
  for (const Column& column : recording.columns) {
    const ValueRange range = range_of(recording, column.name);
    fmt::format_to(out, "{:<26} {:<10} {:<12} {:>12} {:>12}\n", column.name,
                   column.units, role_name(column.role),
                   range.samples ? fmt::format("{:.6g}", range.low) : "-",
                   range.samples ? fmt::format("{:.6g}", range.high) : "-");
  }
  return text;
}

std::string import_report(const ImportedLog& log, const std::string& path,
                          const std::string& joined) {
  const Recording& recording = log.recording;
  std::string text = path + ": " + rows_text(log.counts);
  text += counts_text(log.counts) + blank_text(log.counts, path);
  if (log.joined) text += joined + ": " + rows_text(*log.joined);
  text += sampling_text(recording);
  if (std::ranges::count(recording.status, 0) < std::ssize(recording.status))
    text += fmt::format("status       {}\n", status_words(recording));
  text += range_text(recording, "rate", "deg/s") + rest_text(recording);
  if (find_column(recording, "temperature") != nullptr) {
    text +=
        range_text(recording, "temperature", "degC") + stuck_text(recording);
  } else {
    text +=
        "temperature  not stated by the map: allan needs none, every other "
        "command does ([temperature])\n";
  }
  if (find_column(recording, "true_rate") != nullptr) {
    text += range_text(recording, "true_rate", "deg/s");
  } else {
    text +=
        "true_rate    not stated by the map: train and validate need one "
        "([true_rate] at_rest = true, or a column)\n";
  }
  return text;
}

}  // namespace beamgyro::internal
