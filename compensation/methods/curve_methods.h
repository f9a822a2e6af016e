// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "compensation/methods/method.h"
#include "compensation/models/cubic_spline.h"
#include "compensation/models/lookup_table.h"
#include "compensation/models/polynomial.h"
#include "compensation/models/takagi_sugeno.h"
#include "compensation/models/thermistor_network.h"

namespace beamgyro::internal {

/// No bias at all: the raw rate.
struct NoBias {
  static constexpr const char* kKind = "none";
  static constexpr InputUse kInputUse = InputUse::kNone;
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
    return Eigen::ArrayXd::Zero(x.rows());
  }
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
  static NoneSpec read(MethodSource&) { return {}; }
  std::string method_name() const { return kName; }
  Fit fit(const FitTask& task) const;
};

/// The mean of the training rows.
struct ConstantSpec {
  static constexpr const char* kName = "constant";
  static constexpr InputRule kInputRule = InputRule::kAny;
  static constexpr bool kIsCandidate = true;
  using Function = ConstantBias;
  static ConstantSpec read(MethodSource&) { return {}; }
  std::string method_name() const { return kName; }
  Fit fit(const FitTask& task) const;
};

/// Table [polynomial].
struct PolynomialSpec {
  int degree = 3;  // 0 ... 12
  // false: powers of T - 25 degC in kelvins by the normal equations
  bool normalised = true;

  static constexpr const char* kName = "polynomial";
  static constexpr InputRule kInputRule = InputRule::kTemperatureFirst;
  using Function = Polynomial;
  static PolynomialSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

/// Table [spline].
struct SplineSpec {
  double knot_spacing_K = 5.0;  // [K], see spline_knots()
  SplineEnd end = SplineEnd::kNotAKnot;

  static constexpr const char* kName = "spline";
  static constexpr InputRule kInputRule = InputRule::kOneTemperature;
  static constexpr bool kIsCandidate = true;
  using Function = CubicSpline;
  static SplineSpec read(MethodSource& source);
  std::string method_name() const { return "cubic spline"; }
  Fit fit(const FitTask& task) const;
};

/// Table [table].
struct TableSpec {
  double bin_width_K = 5.0;  // [K], > 0
  bool at_soaks = false;     // an entry for each soak, not for each bin

  static constexpr const char* kName = "table";
  static constexpr InputRule kInputRule = InputRule::kOneTemperature;
  static constexpr bool kIsCandidate = true;
  using Function = LookupTable;
  static TableSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

/// Table [thermistor].
struct ThermistorSpec {
  double b_K = 3950.0;  // [K], > 0

  static constexpr const char* kName = "thermistor";
  static constexpr InputRule kInputRule = InputRule::kOneTemperature;
  static constexpr bool kIsCandidate = true;
  using Function = ThermistorNetwork;
  static ThermistorSpec read(MethodSource& source);
  std::string method_name() const { return "thermistor network"; }
  Fit fit(const FitTask& task) const;
};

/// Table [fuzzy].
struct FuzzySpec {
  int rules = 8;  // >= 2

  static constexpr const char* kName = "fuzzy";
  static constexpr InputRule kInputRule = InputRule::kTemperatureFirst;
  static constexpr bool kIsCandidate = true;
  using Function = TakagiSugeno;
  static FuzzySpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
