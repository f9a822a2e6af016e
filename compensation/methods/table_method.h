// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/lookup_table.h"

namespace beamgyro::internal {

/// Table [table].
struct TableSpec {
  double bin_width_K = 5.0;  // [K], > 0

  static constexpr const char* kName = "table";
  static constexpr InputRule kInputRule = InputRule::kOneTemperature;
  static constexpr bool kIsCandidate = true;
  using Function = LookupTable;
  static TableSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
