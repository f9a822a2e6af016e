// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument for a name that is known not to be measured,
/// such as that of a truth.
void require_measurable(std::string_view name);

/// Returns the names of the measured variables of a recording, in its order,
/// with `status` at the end.
std::vector<std::string> measured_names(const Recording& run);

/// The values of measured variables. Refers to the recording.
class MeasuredSignals {
 public:
  MeasuredSignals() = default;

  /// Throws std::invalid_argument naming one that the recording does not have
  /// or that is not measured.
  MeasuredSignals(const Recording& run, const std::vector<std::string>& names);

  std::size_t count() const { return values_.size(); }
  double at(std::size_t signal, std::size_t sample) const {
    return values_[signal] == nullptr ? status_[sample]
                                      : values_[signal][sample];
  }

 private:
  std::vector<const double*> values_;  // null for the status
  const std::uint8_t* status_ = nullptr;
};

}  // namespace beamgyro::internal
