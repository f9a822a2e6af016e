// SPDX-License-Identifier: MIT
#include "dataset/log/log_quantity.h"

#include <cmath>

#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kFastestRate = 20000.0;               // [deg/s]
constexpr double kColdest = -100.0, kWarmest = 200.0;  // [degC]
constexpr long kMostColumns = 100000;

LogQuantity quantity(const ConfigTable& table, std::string_view name,
                     const std::vector<std::string>& known_units) {
  LogQuantity quantity;
  quantity.signal = recorded_signal(name);
  quantity.column = read_log_column(table);
  quantity.unit = table.choice("unit", known_units);
  quantity.unit_place = table.place("unit");
  if (quantity.unit == "counts") {
    quantity.wrap_bits =
        static_cast<int>(table.integer_or("wrap_bits", 0, 2, 32));
  } else {
    static_cast<void>(table.has("wrap_bits"));
  }
  return quantity;
}

/// Sets the conversion of a unit that needs no further keys.
void set_conversion(LogQuantity& quantity) {
  const UnitConversion conversion =
      unit_conversion(quantity.unit, quantity.signal.units);
  quantity.offset += conversion.offset;
  quantity.scale = conversion.scale;
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

LogQuantity read_log_rate(const ConfigTable& table, std::string_view signal) {
  LogQuantity rate =
      quantity(table, signal,
               {"deg/s", "deg/h", "rad/s", "mrad/s", "V", "mV", "counts"});
  rate.plausible = between(-kFastestRate, kFastestRate);
  rate.offset = table.number_or("offset", 0.0);
  if (rate.unit == "V" || rate.unit == "mV" || rate.unit == "counts") {
    rate.scale = read_scale(table, "scale_deg_per_s");
  } else {
    static_cast<void>(table.has("scale_deg_per_s"));
    set_conversion(rate);
  }
  return rate;
}

LogQuantity read_log_temperature(const ConfigTable& table) {
  LogQuantity temperature = quantity(
      table, "temperature", {"degC", "degF", "K", "V", "mV", "counts"});
  temperature.plausible = between(kColdest, kWarmest);
  if (temperature.unit == "V" || temperature.unit == "mV" ||
      temperature.unit == "counts") {
    temperature.scale = read_scale(table, "scale_K");
    temperature.shift = table.number("offset_degC");
    return temperature;
  }
  static_cast<void>(table.has("scale_K"));
  static_cast<void>(table.has("offset_degC"));
  set_conversion(temperature);
  return temperature;
}

LogQuantity read_log_frequency(const ConfigTable& table,
                               std::string_view signal) {
  LogQuantity frequency = quantity(table, signal, {"Hz", "kHz"});
  set_conversion(frequency);
  return frequency;
}

LogQuantity read_log_voltage(const ConfigTable& table,
                             std::string_view signal) {
  LogQuantity voltage = quantity(table, signal, {"V", "mV"});
  set_conversion(voltage);
  return voltage;
}

}  // namespace beamgyro::internal
