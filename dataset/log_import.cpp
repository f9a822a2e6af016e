// SPDX-License-Identifier: MIT
#include "dataset/log_import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/suggestion.h"
#include "dataset/log_outliers.h"

namespace beamgyro {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A time in the unit of the log. Whole numbers keep every digit: nanoseconds
// since 1970 do not fit into a double.
struct Ticks {
  bool whole = false;
  std::int64_t count = 0;
  double value = 0;
};

double ticks_between(const Ticks& from, const Ticks& to) {
  if (from.whole && to.whole) return static_cast<double>(to.count - from.count);
  return to.value - from.value;
}

template <class Number>
std::errc parse(std::string_view text, Number& number) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || text.empty())
    return std::errc::invalid_argument;
  return error;
}

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

// Column of the text that `column` of the map means, from 0.
std::size_t index_of(const LogColumn& column, const LogText& text,
                     const std::string& path) {
  const auto reject = [&](const std::string& message) {
    throw std::invalid_argument(fmt::format("{}: {}", column.place, message));
  };
  if (column.number > 0) {
    if (column.number > text.width()) {
      reject(fmt::format("{} is out of range; {} has {} columns", column.number,
                         path, text.width()));
    }
    return column.number - 1;
  }
  const std::vector<std::string>& names = text.names();
  if (names.empty()) {
    reject(
        fmt::format("\"{}\" is a name, and header = false; expected the "
                    "number of a column from 1",
                    column.name));
  }
  const auto found = std::find(names.begin(), names.end(), column.name);
  if (found == names.end()) {
    const std::string near = suggestion(column.name, names);
    reject(fmt::format(
        "{} has no column \"{}\"; {}it has {}", path, column.name,
        near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
        fmt::join(names, ", ")));
  }
  if (std::find(found + 1, names.end(), column.name) != names.end()) {
    reject(fmt::format("{} has two columns \"{}\"; expected the number of one",
                       path, column.name));
  }
  return static_cast<std::size_t>(found - names.begin());
}

// Rows of a log on their way into a recording.
class LogReader {
 public:
  LogReader(std::string_view text, const std::filesystem::path& path,
            const LogMap& map)
      : text_(text, path, map.layout), map_(map), path_(path.string()) {
    const auto slot = [&](const LogColumn& column) {
      return text_.want(index_of(column, text_, path_));
    };
    if (map.filter) filter_ = slot(map.filter->column);
    if (map.time.column) time_ = slot(*map.time.column);
    if (map.status) status_ = slot(map.status->column);
    for (const LogQuantity& quantity : map.quantities) {
      slots_.push_back(slot(quantity.column));
      recording_.columns.push_back({quantity.variable,
                                    quantity.units,
                                    quantity.long_name,
                                    quantity.role,
                                    {}});
    }
    values_.resize(slots_.size());
  }

  ImportedLog read() {
    while (text_.next()) take_row();
    drop_outliers();
    check_plausible();
    counts_.kept = recording_.time.size();
    check_enough();
    if (map_.constant_true_rate) {
      recording_.columns.push_back(
          {"true_rate", "degree/s", "rate about the input axis", Role::kTruth,
           std::vector<double>(counts_.kept, *map_.constant_true_rate)});
    }
    recording_.fidelity = "imported";
    recording_.scenario_text = map_.text;
    return {std::move(recording_), counts_};
  }

 private:
  void drop(DropReason reason) { counts_.drop(reason, text_.line()); }

  void take_row() {
    ++counts_.rows;
    if (!text_.is_whole()) {
      if (map_.rules.drop_ragged) {
        if (!filter_) ++row_number_;
        return drop(DropReason::kRagged);
      }
      text_.fail_row(fmt::format(
          "{} cells; expected {} as in the first line (or rules.ragged = "
          "\"drop\" in the map)",
          text_.cells(), text_.width()));
    }
    if (filter_ && !passes_filter()) return drop(DropReason::kFiltered);
    const std::optional<Ticks> ticks = read_ticks();
    if (!ticks) return drop(DropReason::kMissing);
    const double time = time_of(*ticks);
    if (!follows(time)) return;
    const std::optional<std::uint8_t> status = read_status(time);
    if (!status || !read_values((*status & kUnpowered) != 0))
      return drop(DropReason::kMissing);
    if (lines_.empty()) first_ = *ticks;
    lines_.push_back(text_.line());
    recording_.time.push_back(time);
    recording_.status.push_back(*status);
    for (std::size_t i = 0; i < values_.size(); ++i)
      recording_.columns[i].values.push_back(values_[i]);
  }

  bool passes_filter() {
    const LogFilter& filter = *map_.filter;
    if (!filter.number) return text_.cell(*filter_) == filter.text;
    const std::optional<double> number = number_in(*filter_);
    return number && *number == *filter.number;
  }

  std::optional<Ticks> read_ticks() {
    constexpr std::int64_t kMost = std::int64_t{1} << 62;
    Ticks ticks;
    if (!time_) {
      ticks = {true, row_number_, static_cast<double>(row_number_)};
      ++row_number_;
      return ticks;
    }
    ticks.whole = !is_marker(text_.cell(*time_)) &&
                  parse(text_.cell(*time_), ticks.count) == std::errc() &&
                  ticks.count < kMost && ticks.count > -kMost;
    if (ticks.whole) {
      ticks.value = static_cast<double>(ticks.count);
      return ticks;
    }
    const std::optional<double> number = present(*time_);
    if (!number) return std::nullopt;
    ticks.value = *number;
    return ticks;
  }

  double time_of(const Ticks& ticks) const {
    const Ticks& first = lines_.empty() ? ticks : first_;
    const double since = ticks_between(first, ticks);
    const double rate = map_.time.ticks_per_s;
    return map_.time.offset ? (first.value + since) / rate + *map_.time.offset
                            : since / rate;
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
    if (time_) text_.fail(*time_, message);
    text_.fail_row(message);
  }

  std::optional<std::uint8_t> read_status(double time) {
    unsigned bits = 0;
    if (status_) {
      const std::optional<double> number = present(*status_);
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

  bool read_values(bool unpowered) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const LogQuantity& quantity = map_.quantities[i];
      if (unpowered && quantity.role == Role::kMeasured) {
        values_[i] = kNan;
        continue;
      }
      const std::optional<double> raw = present(slots_[i]);
      if (!raw) return false;
      if (!quantity.fits(*raw)) {
        text_.fail(
            slots_[i],
            fmt::format("{} is no count of {} bits (wrap_bits in the "
                        "map); expected a whole number from 0 to {:.0f}",
                        shown_cell(text_.cell(slots_[i])), quantity.wrap_bits,
                        std::ldexp(1.0, quantity.wrap_bits) - 1));
      }
      values_[i] = quantity.value(*raw);
      if (!std::isfinite(values_[i]))
        fail_number(slots_[i], "is out of range", "a smaller number");
    }
    return true;
  }

  bool is_marker(std::string_view cell) const {
    return std::any_of(map_.missing_markers.begin(), map_.missing_markers.end(),
                       [cell](const auto& marker) { return marker == cell; });
  }

  // The number in a cell, or none when it is missing.
  std::optional<double> number_in(std::size_t slot) const {
    const std::string_view cell = text_.cell(slot);
    if (is_marker(cell)) return std::nullopt;
    double value = 0.0;
    const std::errc error = parse(cell, value);
    if (error == std::errc() && std::isfinite(value)) return value;
    if (cell.empty() || equal_but_for_case(cell, "na") ||
        (error == std::errc() && std::isnan(value)))
      return std::nullopt;
    if (error == std::errc())
      fail_number(slot, "is infinite", "a finite number");
    if (error == std::errc::result_out_of_range)
      fail_number(slot, "is out of range", "a finite number");
    fail_number(slot, "is not a number",
                "one such as -12.5, or the text among missing_markers in the "
                "map");
  }

  // The same; none only where the rules drop rows without it.
  std::optional<double> present(std::size_t slot) const {
    const std::optional<double> number = number_in(slot);
    if (!number && !map_.rules.drop_missing) {
      text_.fail(slot, fmt::format("{} is missing; expected a number "
                                   "(rules.missing = \"drop\" in the map drops "
                                   "such rows)",
                                   shown_cell(text_.cell(slot))));
    }
    return number;
  }

  [[noreturn]] void fail_number(std::size_t slot, const char* what,
                                const char* expected) const {
    text_.fail(slot, fmt::format("{} {}; expected {}",
                                 shown_cell(text_.cell(slot)), what, expected));
  }

  void drop_outliers() {
    if (!map_.rules.outliers || lines_.empty()) return;
    const auto found = [&](const char* name) {
      return find_outliers(recording_.time, column_values(recording_, name),
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

  // Wrong units show in values no gyro has.
  void check_plausible() {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const LogQuantity& quantity = map_.quantities[i];
      const std::vector<double>& values = recording_.columns[i].values;
      const auto wrong =
          std::find_if(values.begin(), values.end(), [&](double value) {
            return !std::isnan(value) && !quantity.plausible.contains(value);
          });
      if (wrong == values.end()) continue;
      text_.go_to(lines_[static_cast<std::size_t>(wrong - values.begin())]);
      text_.fail(slots_[i],
                 fmt::format("{} is {:g} {} when read as {}: \"{}\"; expected "
                             "{}, or another unit",
                             shown_cell(text_.cell(slots_[i])), *wrong,
                             quantity.units, quantity.unit_place, quantity.unit,
                             text_of(quantity.plausible)));
    }
  }

  void check_enough() const {
    if (counts_.kept >= 2) return;
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
                    path_, counts_.kept, counts_.rows, dropped));
  }

  LogText text_;
  const LogMap& map_;
  std::string path_;
  std::optional<std::size_t> filter_, time_, status_;  // slots
  std::vector<std::size_t> slots_;                     // of the quantities
  std::vector<double> values_;                         // of one row
  std::int64_t row_number_ = 0;  // of the next row that passes the filter
  Ticks first_;                  // of the first row kept
  Recording recording_;
  std::vector<std::size_t> lines_;  // of the rows kept
  LogCounts counts_;
};

}  // namespace

ImportedLog import_log(std::string_view text, const std::filesystem::path& path,
                       const LogMap& map) {
  return LogReader(text, path, map).read();
}

}  // namespace beamgyro
