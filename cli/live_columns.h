// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "include/beamgyro/gyro.h"

namespace beamgyro::internal {

/// What acts on a gyro at one time.
struct TimedInputs {
  double time = 0;  // [s]
  GyroInputs inputs = {};
};

/// The columns of a stream of inputs: `time`, and any of the inputs of a gyro
/// under the names of recordings, true_rate, true_cross_rate_x ..., or without
/// the "true_", and `powered`.
class LiveColumns {
 public:
  /// Takes the line of names. Throws std::invalid_argument with `place` in
  /// front for a name that is none or there twice, for another unit than that
  /// of a recording, and where `time` is missing.
  LiveColumns(const std::string& names, const std::string& place);

  std::size_t count() const { return columns_.size(); }

  /// Returns the inputs of one line; those that it does not have are those of
  /// `before`. Throws BadLine with `place` in front.
  TimedInputs of(std::span<const double> values, const TimedInputs& before,
                 const std::string& place) const;
  /// The same of a line of CSV.
  TimedInputs of(std::string_view line, const TimedInputs& before,
                 const std::string& place) const;

 private:
  struct Column {
    std::string name;
    double GyroInputs::*input;  // null: of time and powered
  };
  std::vector<Column> columns_;
};

}  // namespace beamgyro::internal
