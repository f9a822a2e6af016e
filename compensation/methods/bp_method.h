// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "compensation/methods/method.h"
#include "compensation/models/bp_network.h"
#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// Table [bp].
struct BpSpec {
  std::vector<int> hidden;      // neurons of each hidden layer
  double goal_deg_per_s = 0.0;  // [deg/s], becomes TrainOptions::goal
  std::vector<double> weight_decays = {0.0};  // best_network() chooses
  TrainOptions training;

  static constexpr const char* kName = "bp";
  static constexpr InputRule kInputRule = InputRule::kNamed;
  using Function = BpNetwork;
  static BpSpec read(MethodSource& source);
  /// Everything but the layers, which `kind = "auto"` takes from the names of
  /// its candidates.
  static BpSpec read_options(const MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
