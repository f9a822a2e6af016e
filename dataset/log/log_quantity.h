// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "config/range.h"
#include "config/table.h"
#include "dataset/recording/signals.h"

namespace beamgyro::internal {

/// A column of a log, by its name in the line of names or by its number.
struct LogColumn {
  std::string name;
  std::size_t number = 0;  // from 1; 0: by name
  std::string place;       // of the key in the map, for messages
};

/// One variable of a recording, and the conversion of a number of the log to
/// its value:
///   value = (raw - offset) scale + shift,
/// `raw` is first read as two's complement of `wrap_bits` bits, if that is set.
struct LogQuantity {
  RecordedSignal signal;
  LogColumn column;
  std::string unit;        // of the log, as the map states it
  std::string unit_place;  // of that key in the map
  double offset = 0;       // [unit]
  double scale = 1;        // [units per unit]
  double shift = 0;        // [units]
  int wrap_bits = 0;       // 0: not wrapped
  Range plausible = any();
  bool joined = false;  // from the log that the map joins

  /// Returns whether `raw` is a whole number of `wrap_bits` bits; true if that
  /// is not set.
  bool fits(double raw) const;
  double value(double raw) const;
};

/// Reads the key `column` of a table, or another one: a text is a name, an
/// integer is a number.
LogColumn read_log_column(const ConfigTable& table,
                          std::string_view key = "column");

/// Reads the keys `column` and `unit` of a signal, and the keys that the unit
/// requires: of an angular rate in deg/s, rad/s, V, mV or counts; of a
/// temperature in degC, degF, K, V, mV or counts; of a number in a multiple of
/// its unit. Throws std::invalid_argument that names the key for a unit that is
/// missing or unknown, and as ConfigTable.
LogQuantity read_log_quantity(const ConfigTable& table,
                              std::string_view signal);

}  // namespace beamgyro::internal
