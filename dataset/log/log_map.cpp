// SPDX-License-Identifier: MIT
#include "dataset/log/log_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "config/config_node.h"
#include "config/option_message.h"
#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

constexpr long kLongest = std::numeric_limits<std::int32_t>::max();

LogLayout read_layout(const ConfigTable& root) {
  LogLayout layout;
  const std::string delimiter =
      root.choice_or("delimiter", "auto", {"auto", ",", "\t", ";", "|", " "});
  if (delimiter != "auto") layout.delimiter = delimiter.front();
  layout.decimal = root.choice_or("decimal", ".", {".", ","}).front();
  layout.header = root.flag_or("header", true);
  if (layout.header) {
    layout.header_line = static_cast<std::size_t>(
        root.integer_or("header_line", 0, 1, kLongest));
  } else {
    static_cast<void>(root.has("header_line"));
  }
  if (layout.header) {
    if (const auto begin = root.optional_text("repeated_header")) {
      if (begin->empty())
        root.fail("repeated_header",
                  "\"\" begins every line; expected the text with which a "
                  "header within the log begins, such as \"Channels\"");
      layout.repeated_header = *begin;
    }
  } else {
    static_cast<void>(root.has("repeated_header"));
  }
  layout.skip_rows =
      static_cast<std::size_t>(root.integer_or("skip_rows", 0, 0, kLongest));
  if (root.has("comment_prefixes")) {
    layout.comment_prefixes = root.texts("comment_prefixes");
    for (const std::string& prefix : layout.comment_prefixes) {
      if (prefix.empty())
        root.fail("comment_prefixes",
                  "\"\" would make every line a comment; expected a text such "
                  "as \"#\"");
    }
  }
  return layout;
}

LogFilter read_filter(const ConfigTable& table) {
  LogFilter filter;
  filter.column = read_log_column(table);
  if (table.holds_number("value")) {
    filter.number = table.number("value");
  } else {
    filter.text = table.text("value");
  }
  return filter;
}

[[noreturn]] void reject_other_axes(const ConfigTable& gyro) {
  const std::vector<std::string> keys = gyro.keys();
  gyro.fail("column",
            keys.empty() || gyro.has("unit")
                ? "missing; expected the name of the column in quotes"
                : fmt::format("missing, and '{}' is no axis; expected "
                              "[gyro] with a column, or [gyro.x], [gyro.y], "
                              "[gyro.z]",
                              printable(keys.front())));
}

// Reads every axis, so that a mistake in one that was not asked for is found,
// too.
LogQuantity read_gyro(const ConfigTable& root, const std::string& axis) {
  const ConfigTable gyro = root.table("gyro");
  std::vector<std::string> axes;
  std::vector<LogQuantity> rates;
  for (const char* name : {"x", "y", "z"}) {
    if (const auto table = gyro.optional_table(name)) {
      axes.emplace_back(name);
      rates.push_back(read_log_quantity(*table, "rate"));
    }
  }
  if (axes.empty()) {
    if (!gyro.has("column")) reject_other_axes(gyro);
    if (!axis.empty()) {
      throw option_error("{}: {}: has no axes; expected no {}",
                         NamedOption{"axis", axis}, root.place("gyro"),
                         NamedOption{"axis"});
    }
    return read_log_quantity(gyro, "rate");
  }
  if (axis.empty() && axes.size() > 1) {
    throw option_error(
        "{}: has the axes {}; expected {} to choose one", root.place("gyro"),
        fmt::to_string(fmt::join(axes, ", ")), NamedOption{"axis"});
  }
  if (axis.empty()) return rates.front();
  const auto found = std::find(axes.begin(), axes.end(), axis);
  if (found == axes.end()) {
    throw option_error("{}: {}: has no such axis; expected one of {}",
                       NamedOption{"axis", axis}, root.place("gyro"),
                       fmt::to_string(fmt::join(axes, ", ")));
  }
  return rates[static_cast<std::size_t>(found - axes.begin())];
}

LogRules read_rules(const ConfigTable& table) {
  LogRules rules;
  const auto drops = [&](const char* key, const char* word, bool otherwise) {
    return table.choice_or(key, otherwise ? word : "error", {word, "error"}) ==
           word;
  };
  const std::string ragged =
      table.choice_or("ragged", "error", {"drop", "fill", "error"});
  rules.drop_ragged = ragged == "drop";
  rules.fill_short = ragged == "fill";
  rules.drop_missing = drops("missing", "drop", true);
  rules.drop_duplicates = drops("duplicates", "drop_later", true);
  rules.drop_backward = drops("backward", "drop", false);
  rules.keep_fast_temperature = drops("fast_temperature", "keep", false);
  if (const auto outliers = table.optional_table("outliers")) {
    const long window = outliers->integer_or("window", 25, 5, 999);
    if (window % 2 == 0) {
      outliers->fail("window", fmt::format("{} is even; expected an odd number "
                                           "of rows",
                                           window));
    }
    rules.outliers = OutlierRule{static_cast<std::size_t>(window),
                                 outliers->number_or("k", 20, positive())};
  }
  return rules;
}

// The tables of signals beside the gyro, in the order of the recording.
constexpr const char* kSignalTables[] = {"temperature", "drive_frequency",
                                         "drive_voltage", "quadrature",
                                         "true_rate"};

// Reads what the rows of one log hold, apart from its quantities.
LogMap read_source(const ConfigTable& table) {
  LogMap map;
  map.layout = read_layout(table);
  if (table.has("missing_markers"))
    map.missing_markers = table.texts("missing_markers");
  if (const auto filter = table.optional_table("filter"))
    map.filter = read_filter(*filter);
  map.time = read_log_time(table.table("time"));
  map.rules = read_rules(table.table_or_empty("rules"));
  return map;
}

// The times of a log that is joined are those of its clock.
LogJoin read_join(const ConfigTable& root) {
  const ConfigTable table = root.table("join");
  LogMap map = read_source(table);
  if (!map.time.offset) map.time.offset = 0.0;
  for (const char* signal : kSignalTables) {
    if (!table.has(signal)) continue;
    if (root.has(signal))
      table.fail(signal, "is in the other log, too; expected it in one");
    map.quantities.push_back(read_log_quantity(table.table(signal), signal));
  }
  if (map.quantities.empty())
    root.fail("join",
              "takes nothing from the second log; expected a table such as "
              "[join.temperature]");
  const double gap = table.number("max_gap_s", positive());
  return {std::make_shared<const LogMap>(std::move(map)), gap,
          root.place("join")};
}

bool is_rate_stated(const ConfigTable& root) {
  return root.has("true_rate") && !root.table("true_rate").has("column");
}

void read_quantities(const ConfigTable& root, const std::string& axis,
                     LogMap& map) {
  std::vector<LogQuantity>& quantities = map.quantities;
  const LogQuantity rate = read_gyro(root, axis);
  if (rate.unit == "V" || rate.unit == "mV") {
    quantities.push_back({.signal = recorded_signal("output"),
                          .column = rate.column,
                          .unit = rate.unit,
                          .unit_place = rate.unit_place,
                          .scale = unit_conversion(rate.unit, "V").scale});
  }
  quantities.push_back(rate);
  for (const char* signal : kSignalTables) {
    if (const auto table = root.optional_table(signal)) {
      if (signal == std::string_view("true_rate") && is_rate_stated(root))
        continue;
      quantities.push_back(read_log_quantity(*table, signal));
    } else if (map.join) {
      for (const LogQuantity& joined : map.join->map->quantities) {
        if (joined.signal.name != signal) continue;
        quantities.push_back(joined);
        quantities.back().joined = true;
      }
    }
  }
}

void read_stated_rate(const ConfigTable& table, LogMap& map) {
  if (table.has("column")) {
    static_cast<void>(table.has("constant_deg_per_s"));
  } else if (table.has("constant_deg_per_s")) {
    map.constant_true_rate = table.number("constant_deg_per_s");
  } else if (table.flag("at_rest")) {
    map.constant_true_rate = 0.0;
  }
  static_cast<void>(table.has("at_rest"));
}

LogStatus read_status(const ConfigTable& table) {
  LogStatus status;
  status.column = read_log_column(table);
  const auto values = [&](const char* key) {
    return table.has(key) ? table.integers(key, -kLongest, kLongest)
                          : std::vector<long>();
  };
  status.unpowered = values("unpowered");
  status.saturated = values("saturated");
  status.not_locked = values("not_locked");
  if (table.has("valid")) status.valid = values("valid");
  if (!status.valid && status.unpowered.empty() && status.saturated.empty() &&
      status.not_locked.empty()) {
    table.fail("valid",
               "missing; expected valid, unpowered, saturated or not_locked "
               "with the values of the column that mean it");
  }
  return status;
}

std::vector<std::array<double, 2>> read_powered(const ConfigTable& root) {
  constexpr const char* kKey = "powered_s";
  constexpr double kEver = std::numeric_limits<double>::infinity();
  if (!root.has(kKey)) return {};
  if (root.holds_number(kKey)) return {{root.number(kKey), kEver}};
  std::vector<std::array<double, 2>> powered;
  double last = -kEver;
  for (const std::vector<double>& row : root.rows(kKey, 2)) {
    if (!(row[0] >= last && row[1] > row[0])) {
      root.fail(kKey, powered.size(),
                fmt::format("[{}, {}] is out of order; expected [on, off] "
                            "times that rise",
                            row[0], row[1]));
    }
    powered.push_back({row[0], row[1]});
    last = row[1];
  }
  if (powered.empty())
    root.fail(kKey, "an array of 0 is wrong here; expected [[on, off], ...]");
  return powered;
}

}  // namespace

std::uint8_t LogStatus::bits(double value) const {
  const auto among = [value](const std::vector<long>& values) {
    return std::any_of(values.begin(), values.end(), [value](long v) {
      return static_cast<double>(v) == value;
    });
  };
  unsigned bits = 0;
  if (among(unpowered)) bits |= kUnpowered;
  if (among(saturated)) bits |= kOutputSaturated;
  if (among(not_locked)) bits |= kLoopNotLocked;
  if (valid && bits == 0 && !among(*valid)) bits |= kLoopNotLocked;
  return static_cast<std::uint8_t>(bits);
}

LogMap read_log_map(const ConfigDocument& document, const std::string& axis) {
  const ConfigTable& root = document.root();
  LogMap map = read_source(root);
  map.text = document.text();
  if (root.has("join")) map.join = read_join(root);
  read_quantities(root, axis, map);
  if (const auto table = root.optional_table("true_rate"))
    read_stated_rate(*table, map);
  if (const auto table = root.optional_table("status"))
    map.status = read_status(*table);
  map.powered = read_powered(root);
  document.reject_unknown_keys();
  return map;
}

}  // namespace beamgyro::internal
