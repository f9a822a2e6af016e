// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

/// p(x) = c_0 + c_1 x_0 + ... + c_n x_0^n + d_1 x_1 + ... + d_m x_m: a
/// polynomial of the first input and a straight line in each further one.
struct Polynomial {
  std::vector<double> coefficients;  // c_0 ... c_n
  std::vector<double> slopes = {};   // d_1 ... d_m

  /// Returns p of each row of x, which has 1 + m columns.
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;

  static constexpr const char* kKind = "polynomial";
  static constexpr InputUse kInputUse = InputUse::kAny;
  nlohmann::ordered_json parameters() const;
  static Polynomial read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

/// Fits by least squares with Householder QR. Throws std::invalid_argument when
/// `x` does not determine a polynomial of that degree and the slopes.
Polynomial fit_polynomial(const Eigen::Ref<const Eigen::ArrayXXd>& x,
                          const Eigen::Ref<const Eigen::ArrayXd>& y,
                          int degree);

/// Fits the same by the normal equations and Cholesky, as programs do that do
/// not scale their inputs. Their condition is the square of that of the powers
/// of `x`: harmless for a cubic in kelvins about 25 degC, and ruinous for a
/// high degree over a range far from it. Throws std::invalid_argument when that
/// is more than double precision holds.
Polynomial fit_polynomial_by_normal_equations(
    const Eigen::Ref<const Eigen::ArrayXXd>& x,
    const Eigen::Ref<const Eigen::ArrayXd>& y, int degree);

/// Returns the coefficients of p about another origin: q(x) = p(x + origin).
std::vector<double> shifted(std::vector<double> coefficients, double origin);

}  // namespace beamgyro::internal
