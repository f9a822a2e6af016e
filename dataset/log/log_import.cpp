// SPDX-License-Identifier: MIT
#include "dataset/log/log_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/option_message.h"
#include "dataset/log/log_advice.h"
#include "dataset/log/log_clock.h"
#include "dataset/log/log_drift.h"
#include "dataset/log/log_join.h"
#include "dataset/log/log_numbers.h"
#include "dataset/log/log_statistics.h"

namespace beamgyro::internal {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// What a thermistor can read.
std::string thermistor_readings(const Thermistor& thermistor) {
  return thermistor.divider
             ? fmt::format(
                   "a number between 0 and full_scale = {}, which mean "
                   "a short and an open thermistor, or it among "
                   "missing_markers in the map",
                   thermistor.divider->full_scale)
             : "a resistance above 0";
}

// Converts the rows of a log to a recording.
class LogReader {
 public:
  LogReader(std::string_view text, const std::filesystem::path& path,
            const LogMap& map, JoinedRows* joined = nullptr)
      : log_(text, path, map),
        map_(map),
        clock_(log_, map.time),
        joined_(joined) {
    if (map.filter) filter_ = log_.slot(map.filter->column);
    if (map.status) status_ = log_.slot(map.status->column);
    for (const LogQuantity& quantity : map.quantities) {
      slots_.push_back(quantity.joined ? 0 : log_.slot(quantity.column));
      recording_.columns.push_back(column_of(quantity.signal.name, {}));
    }
    values_.resize(slots_.size());
    blank_rows_.resize(slots_.size());
    if (map.join) joined_values_.resize(map.join->map->quantities.size());
  }

  ImportedLog read() {
    while (log_.text().next()) take_row();
    drop_outliers();
    check_plausible();
    counts_.kept = recording_.time.size();
    find_most_blank();
    check_enough();
    check_time_unit(recording_, lines_, map_, log_.path());
    if (map_.constant_true_rate) {
      recording_.columns.push_back(column_of(
          "true_rate",
          std::vector<double>(counts_.kept, *map_.constant_true_rate)));
    }
    recording_.fidelity = "imported";
    recording_.scenario_text = map_.text;
    return {std::move(recording_), counts_, {}};
  }

  // A bound of the rounding errors of the times on the clock of the log [s].
  double rounding() const { return rounding_; }

 private:
  void drop(DropReason reason) { counts_.drop(reason, log_.text().line()); }

  void take_row() {
    ++counts_.rows;
    if (!log_.text().is_whole() &&
        !(map_.rules.fill_short && log_.text().is_short())) {
      if (map_.rules.drop_ragged) {
        if (!filter_) clock_.skip_row();
        return drop(DropReason::kRagged);
      }
      log_.text().fail_row(fmt::format("{} cells; {}", log_.text().cells(),
                                       width_advice(log_.text(), map_.layout)));
    }
    if (filter_ && !passes_filter()) return drop(DropReason::kFiltered);
    const std::optional<LogTicks> ticks = clock_.read();
    if (!ticks) return drop(DropReason::kMissing);
    if (!clock_.is_within(*ticks)) return drop(DropReason::kOutside);
    rounding_ = std::max(rounding_, clock_.rounding(*ticks));
    const double time = clock_.time(lines_.empty() ? *ticks : first_, *ticks);
    if (!follows(time)) return;
    const std::optional<std::uint8_t> status = read_status(time);
    if (!status) return drop(DropReason::kMissing);
    if (joined_ != nullptr && !read_joined(*ticks))
      return drop(DropReason::kNotJoined);
    if (!read_values((*status & kUnpowered) != 0))
      return drop(DropReason::kMissing);
    if (lines_.empty()) first_ = *ticks;
    lines_.push_back(log_.text().line());
    recording_.time.push_back(time);
    recording_.status.push_back(*status);
    for (std::size_t i = 0; i < values_.size(); ++i)
      recording_.columns[i].values.push_back(values_[i]);
  }

  bool passes_filter() {
    const LogFilter& filter = *map_.filter;
    if (!filter.number) return log_.text().cell(*filter_) == filter.text;
    const std::optional<double> number = log_.number_in(*filter_);
    return number && *number == *filter.number;
  }

  // Whether the time comes after that of the last row kept.
  bool follows(double time) {
    if (lines_.empty() || time > recording_.time.back()) return true;
    const bool equal = time == recording_.time.back();
    if (equal ? map_.rules.drop_duplicates : map_.rules.drop_backward) {
      drop(equal ? DropReason::kDuplicate : DropReason::kBackward);
      return false;
    }
    const std::string message =
        equal ? fmt::format(
                    "the time is that of line {} again; expected one "
                    "row a time (rules.duplicates = \"drop_later\" in "
                    "the map drops the later one)",
                    lines_.back())
              : fmt::format(
                    "the time goes back by {:g} s from that of line {}; "
                    "expected the rows of one run of one sensor (a [filter] in "
                    "the map picks them, rules.backward = \"drop\" drops rows)",
                    recording_.time.back() - time, lines_.back());
    clock_.fail(message);
  }

  std::optional<std::uint8_t> read_status(double time) {
    unsigned bits = 0;
    if (status_) {
      const std::optional<double> number = log_.present(*status_);
      if (!number) return std::nullopt;
      bits = map_.status->bits(*number);
    }
    const auto is_on = [time](const std::array<double, 2>& on_off) {
      return time >= on_off[0] && time < on_off[1];
    };
    if (!map_.powered.empty() &&
        std::none_of(map_.powered.begin(), map_.powered.end(), is_on))
      bits |= kUnpowered;
    return static_cast<std::uint8_t>(bits);
  }

  bool read_joined(const LogTicks& ticks) {
    const double time = clock_.common_time(ticks);
    if (!first_common_) first_common_ = time;
    last_common_ = time;
    return joined_->read(time, clock_.rounding(ticks), joined_values_);
  }

  bool read_values(bool unpowered) {
    std::size_t next_joined = 0;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const LogQuantity& quantity = map_.quantities[i];
      if (quantity.joined) values_[i] = joined_values_[next_joined++];
      if (unpowered && quantity.signal.role == Role::kMeasured) {
        values_[i] = kNan;
        continue;
      }
      if (quantity.joined) continue;
      const std::optional<double> raw = log_.present(slots_[i]);
      if (!raw) {
        ++blank_rows_[i];
        return false;
      }
      if (!quantity.fits(*raw)) {
        log_.fail(slots_[i],
                  fmt::format("is no count of {} bits (wrap_bits in the map)",
                              quantity.wrap_bits),
                  fmt::format("a whole number from 0 to {:.0f}",
                              std::ldexp(1.0, quantity.wrap_bits) - 1));
      }
      values_[i] = quantity.value(*raw);
      if (quantity.thermistor && std::isnan(values_[i]))
        log_.fail(slots_[i], "is no reading of this thermistor",
                  thermistor_readings(*quantity.thermistor));
      if (!std::isfinite(values_[i]))
        log_.fail(slots_[i], "is out of range", "a smaller number");
    }
    return true;
  }

  void find_most_blank() {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const std::string_view signal = map_.quantities[i].signal.name;
      if (blank_rows_[i] <= counts_.most_blank.rows || signal == "rate" ||
          signal == "output")
        continue;
      counts_.most_blank = {std::string(signal), blank_rows_[i]};
    }
  }

  void drop_outliers() {
    if (!map_.rules.outliers || lines_.empty()) return;
    const auto found = [&](const char* name) {
      const Column* column = find_column(recording_, name);
      return column == nullptr ? std::vector<bool>(lines_.size(), false)
                               : find_outliers(recording_.time, column->values,
                                               *map_.rules.outliers);
    };
    const std::vector<bool> rate = found("rate");
    const std::vector<bool> temperature = found("temperature");
    std::vector<bool> keep(lines_.size(), true);
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      if (!rate[k] && !temperature[k]) continue;
      keep[k] = false;
      counts_.drop(
          rate[k] ? DropReason::kRateOutlier : DropReason::kTemperatureOutlier,
          lines_[k]);
    }
    const auto thin = [&](auto& values) {
      std::size_t to = 0;
      for (std::size_t k = 0; k < keep.size(); ++k)
        if (keep[k]) values[to++] = values[k];
      values.resize(to);
    };
    thin(lines_);
    thin(recording_.time);
    thin(recording_.status);
    for (Column& column : recording_.columns) thin(column.values);
  }

  // Throws for values that no gyro has, which mean a wrong unit.
  void check_plausible() {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const LogQuantity& quantity = map_.quantities[i];
      if (quantity.joined) continue;  // checked in the log it is from
      const std::vector<double>& values = recording_.columns[i].values;
      const auto wrong =
          std::find_if(values.begin(), values.end(), [&](double value) {
            return !std::isnan(value) && !quantity.plausible.contains(value);
          });
      if (wrong == values.end()) continue;
      log_.text().return_to(
          lines_[static_cast<std::size_t>(wrong - values.begin())]);
      log_.fail(slots_[i],
                fmt::format("is {:g} {} when read as {}: \"{}\"", *wrong,
                            quantity.signal.units, quantity.unit_place,
                            quantity.unit),
                text_of(quantity.plausible) + (quantity.unit == "counts"
                                                   ? ", or another scale or "
                                                     "wrap_bits"
                                                   : ", or another unit"));
    }
  }

  // Throws when the joined log has nothing to say about any row.
  void check_joined() const {
    if (joined_ == nullptr || !first_common_ || counts_.kept > 0) return;
    const bool overlaps =
        *first_common_ <= joined_->end() && last_common_ >= joined_->begin();
    const std::string advice =
        overlaps ? fmt::format(
                       "the second has a period of {:.6g} s; "
                       "expected a larger join.max_gap_s",
                       joined_->period())
                 : "expected logs that overlap (join.time.zero or "
                   "join.time.offset_s in the map shifts the second)";
    throw std::invalid_argument(fmt::format(
        "{}: has times from {:.6f} to {:.6f} s, the log joined by {} from "
        "{:.6f} to {:.6f} s on the same clock, and no row is between two of "
        "its rows at most {:g} s apart (join.max_gap_s); {}",
        log_.path(), *first_common_, last_common_, map_.join->place,
        joined_->begin(), joined_->end(), map_.join->longest_gap, advice));
  }

  void check_enough() const {
    if (counts_.kept >= 2) return;
    check_joined();
    std::string dropped;
    for (std::size_t i = 0; i < kDropReasons; ++i) {
      const DroppedRows& rows = counts_.dropped[i];
      if (rows.rows == 0) continue;
      dropped +=
          fmt::format("; {} {}, the first in line {}", rows.rows,
                      reason_name(static_cast<DropReason>(i)), rows.first_line);
    }
    throw std::invalid_argument(
        fmt::format("{}: {} of {} rows are usable; expected at least two{}",
                    log_.path(), counts_.kept, counts_.rows, dropped));
  }

  LogNumbers log_;
  const LogMap& map_;
  LogClock clock_;
  std::optional<std::size_t> filter_, status_;  // slots
  std::vector<std::size_t> slots_;              // of the quantities
  std::vector<double> values_;                  // of one row
  std::vector<std::size_t> blank_rows_;         // by quantity
  JoinedRows* joined_;                          // none: null
  std::vector<double> joined_values_;           // of one row
  std::optional<double> first_common_;          // time of the first row [s]
  double last_common_ = 0;                      // [s]
  double rounding_ = 0;                         // [s], of all times read
  LogTicks first_;                              // of the first row kept
  Recording recording_;
  std::vector<std::size_t> lines_;  // of the rows kept
  LogCounts counts_;
};

}  // namespace

const char* reason_name(DropReason reason) {
  constexpr std::array<const char*, kDropReasons> kNames = {
      "filtered out",
      "wrong number of cells",
      "missing values",
      "duplicate times",
      "backward times",
      "outliers of the rate",
      "outliers of the temperature",
      "outside time.from and time.to",
      "without a value of the joined log"};
  return kNames[static_cast<std::size_t>(reason)];
}

void LogCounts::drop(DropReason reason, std::size_t line) {
  DroppedRows& rows_of = dropped[static_cast<std::size_t>(reason)];
  if (rows_of.rows == 0 || line < rows_of.first_line) rows_of.first_line = line;
  ++rows_of.rows;
}

ImportedLog import_log(std::string_view text, const std::filesystem::path& path,
                       const LogMap& map,
                       const std::optional<SecondLog>& joined) {
  if (map.join && !joined) {
    throw option_error("{}: needs a second log; expected {}", map.join->place,
                       NamedOption{"join", "LOG.csv"});
  }
  if (joined && !map.join) {
    throw option_error(
        "{}: the map has no table [join]; expected one that states what the "
        "second log holds",
        NamedOption{"join", joined->path.string()});
  }
  if (!joined) return LogReader(text, path, map).read();
  LogReader reader(joined->text, joined->path, *map.join->map);
  ImportedLog second = reader.read();
  JoinedRows rows(std::move(second.recording), map.join->longest_gap,
                  reader.rounding());
  ImportedLog log = LogReader(text, path, map, &rows).read();
  log.joined = second.counts;
  return log;
}

}  // namespace beamgyro::internal
