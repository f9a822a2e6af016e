// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "compensation/methods/method.h"
#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

/// Gaussian bells about centres beside a plane (Broomhead and Lowe, Complex
/// Systems 2, 1988, 321), of scaled inputs x:
///
///   y = a_0 + Σ_j a_j x_j + Σ_i w_i exp(-|x - c_i|^2 / (2 width^2))
struct RadialBasis {
  Eigen::MatrixXd centres;  // one row each
  double width = 1.0;       // > 0, scaled
  Eigen::VectorXd plane;    // a_0, a_1, ...
  Eigen::VectorXd weights;  // one per centre

  /// One sample per row.
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;

  static constexpr const char* kKind = "radial_basis";
  static constexpr InputUse kInputUse = InputUse::kAny;
  nlohmann::ordered_json parameters() const;
  static RadialBasis read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

/// Fits up to `count` centres among the points: the one nearest to their mean,
/// then each time the point farthest from all centres so far. The width is
/// `width_share` times the mean distance of a centre from the nearest other
/// one. Plane and weights minimise the mean square error plus `ridge` |w|^2.
/// Throws std::invalid_argument for points without two places.
RadialBasis fit_radial_basis(const Eigen::Ref<const Eigen::ArrayXXd>& x,
                             const Eigen::Ref<const Eigen::ArrayXd>& y,
                             int count, double width_share, double ridge);

/// Table [radial_basis].
struct RadialBasisSpec {
  int centres = 8;           // >= 1
  double width_share = 1.5;  // [-], > 0
  double ridge = 1e-6;       // [-], > 0

  static constexpr const char* kName = "radial_basis";
  static constexpr InputRule kInputRule = InputRule::kTemperatureFirst;
  static constexpr bool kIsCandidate = true;
  using Function = RadialBasis;
  static RadialBasisSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
