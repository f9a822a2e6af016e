// SPDX-License-Identifier: MIT
#include "dataset/log/log_quantity.h"

#include <cmath>

#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kFastestRate = 20000.0;               // [deg/s]
constexpr double kColdest = -100.0, kWarmest = 200.0;  // [degC]
constexpr long kMostColumns = 100000;

// The units that the map may state for a signal of the unit `units`.
std::vector<std::string> known_units(std::string_view units) {
  if (units == "degree/s")
    return {"deg/s", "deg/h", "rad/s", "mrad/s", "V", "mV", "counts"};
  if (units == "degC") return {"degC", "degF", "K", "V", "mV", "counts"};
  if (units == "Hz") return {"Hz", "kHz"};
  return {"V", "mV"};
}

double read_scale(const ConfigTable& table, std::string_view key) {
  const double scale = table.number(key);
  if (scale == 0.0)
    table.fail(key, "0 is out of range; expected a number other than 0");
  return scale;
}

}  // namespace

bool LogQuantity::fits(double raw) const {
  return wrap_bits == 0 || (raw == std::floor(raw) && raw >= 0.0 &&
                            raw < std::ldexp(1.0, wrap_bits));
}

double LogQuantity::value(double raw) const {
  if (wrap_bits > 0 && raw >= std::ldexp(1.0, wrap_bits - 1))
    raw -= std::ldexp(1.0, wrap_bits);
  return (raw - offset) * scale + shift;
}

LogColumn read_log_column(const ConfigTable& table, std::string_view key) {
  LogColumn column;
  column.place = table.place(key);
  if (table.holds_number(key)) {
    column.number =
        static_cast<std::size_t>(table.integer(key, 1, kMostColumns));
  } else {
    column.name = table.text(key);
    if (column.name.empty())
      table.fail(key, "\"\" is no name; expected the name of a column");
  }
  return column;
}

LogQuantity read_log_quantity(const ConfigTable& table,
                              std::string_view signal) {
  LogQuantity quantity;
  quantity.signal = recorded_signal(signal);
  quantity.column = read_log_column(table);
  const std::string_view units = quantity.signal.units;
  quantity.unit = table.choice("unit", known_units(units));
  quantity.unit_place = table.place("unit");
  const bool is_counts = quantity.unit == "counts";
  if (is_counts) {
    quantity.wrap_bits =
        static_cast<int>(table.integer_or("wrap_bits", 0, 2, 32));
  } else {
    static_cast<void>(table.has("wrap_bits"));
  }
  const bool is_rate = units == "degree/s", is_temperature = units == "degC";
  if (is_rate) {
    quantity.plausible = between(-kFastestRate, kFastestRate);
    quantity.offset = table.number_or("offset", 0.0);
  }
  if (is_temperature) quantity.plausible = between(kColdest, kWarmest);
  const bool is_raw =
      is_counts || quantity.unit == "V" || quantity.unit == "mV";
  if (is_raw && (is_rate || is_temperature)) {
    quantity.scale = read_scale(table, is_rate ? "scale_deg_per_s" : "scale_K");
    if (is_temperature) quantity.shift = table.number("offset_degC");
    return quantity;
  }
  if (is_rate) static_cast<void>(table.has("scale_deg_per_s"));
  if (is_temperature)
    for (const char* key : {"scale_K", "offset_degC"})
      static_cast<void>(table.has(key));
  const UnitConversion conversion = unit_conversion(quantity.unit, units);
  quantity.offset += conversion.offset;
  quantity.scale = conversion.scale;
  return quantity;
}

}  // namespace beamgyro::internal
