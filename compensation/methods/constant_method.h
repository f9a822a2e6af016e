// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "compensation/methods/method.h"
#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

/// No bias at all: the raw rate.
struct NoBias {
  static constexpr const char* kKind = "none";
  static constexpr InputUse kInputUse = InputUse::kNone;
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;
  nlohmann::ordered_json parameters() const;
  static NoBias read(const JsonNode&, std::size_t) { return {}; }
  void put_arrays(FirmwareArrays&) const {}
};

/// The same bias everywhere.
struct ConstantBias {
  double value = 0.0;

  static constexpr const char* kKind = "constant";
  static constexpr InputUse kInputUse = InputUse::kNone;
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;
  nlohmann::ordered_json parameters() const;
  static ConstantBias read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
};

/// The raw rate.
struct NoneSpec {
  static constexpr const char* kName = "none";
  static constexpr InputRule kInputRule = InputRule::kAny;
  static constexpr bool kIsCandidate = true;
  using Function = NoBias;
  static NoneSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

/// The mean of the training rows.
struct ConstantSpec {
  static constexpr const char* kName = "constant";
  static constexpr InputRule kInputRule = InputRule::kAny;
  static constexpr bool kIsCandidate = true;
  using Function = ConstantBias;
  static ConstantSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
