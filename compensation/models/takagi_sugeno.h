// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

/// Fuzzy model of Takagi and Sugeno (IEEE Trans. SMC 15, 1985, 116): rules "if
/// x_0 is near c_i then y = a_i0 + a_i1 x_0 + a_i2 x_1 + ...", blended by
/// Gaussian memberships,
///
///   y = Σ w_i y_i / Σ w_i,   w_i = exp(-((x_0 - c_i) / width)^2 / 2)
struct TakagiSugeno {
  Eigen::ArrayXd centres;       // one per rule, of the scaled first input
  double width = 1.0;           // > 0, scaled
  Eigen::MatrixXd consequents;  // one row per rule: a_i0, a_i1, ...

  /// Returns y of each row of x.
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;

  static constexpr const char* kKind = "fuzzy";
  static constexpr InputUse kInputUse = InputUse::kAny;
  nlohmann::ordered_json parameters() const;
  static TakagiSugeno read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

/// Fits a model with `rules` centres spread evenly over [-1, 1] and half of
/// their distance as width. The consequents are the least-squares solution of
/// least norm, so that a rule without points follows its neighbours. Throws
/// std::invalid_argument for fewer than 2 rules or no points.
TakagiSugeno fit_takagi_sugeno(const Eigen::Ref<const Eigen::ArrayXXd>& x,
                               const Eigen::Ref<const Eigen::ArrayXd>& y,
                               int rules);

}  // namespace beamgyro::internal
