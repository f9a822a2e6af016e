// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "compensation/models/bias_function.h"
#include "compensation/models/lookup_table.h"

namespace beamgyro::internal {

/// Spurious resonances that cross the drive's while the temperature changes.
/// Each is a bump of the bias and its twin in the quadrature, of which half a
/// bump lies to either side. With u_k = 2 (t - place_k) / width_k and t the
/// scaled temperature of the beam,
///
///   b(t) = rest(t) + Σ_k bias_height_k / (1 + u_k^2)            [deg/s]
///   q(t) = Σ_n smooth_n t^n - Σ_k quadrature_height_k u_k / (1 + u_k^2)
///
/// The last input is the scaled quadrature q, the others tell the place of the
/// beam, t_0 = Σ_j position_j x_j. The quadrature corrects it: t = t_0 + d. Of
/// kBeamShifts shifts d_i, evenly from -kLargestBeamShift to kLargestBeamShift
/// position_sigma, d is the mean with the weights
///
///   exp(-(d_i / position_sigma)^2 / 2) / (1 + r_i^2 / 3)^2
///
/// of a normal prior and of Student's distribution with 3 degrees of freedom,
/// r_i = (q - q(t_0 + d_i)) / quadrature_sigma. Quadrature that suits no shift,
/// as under a rate that leaks into it, so moves the place little.
struct ResonanceCurve {
  Eigen::VectorXd position;            // one for each input but the last
  Eigen::VectorXd smooth;              // at least one
  Eigen::VectorXd places, widths;      // one for each resonance, widths > 0
  Eigen::VectorXd bias_heights;        // [deg/s]
  Eigen::VectorXd quadrature_heights;  // scaled
  LookupTable rest;                    // over the scaled temperature [deg/s]
  double quadrature_sigma = 1.0;       // scaled, > 0
  double position_sigma = 1.0;         // scaled, > 0

  /// Σ_k bias_height_k / (1 + u_k^2) at the scaled temperature t [deg/s].
  double bumps_at(double t) const;

  /// q(t) without a shift.
  double quadrature_at(double t) const;

  /// The scaled temperature of the beam of a sample x.
  double beam_at(const Eigen::Ref<const Eigen::RowVectorXd>& x) const;

  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;

  static constexpr const char* kKind = "resonances";
  static constexpr InputUse kInputUse = InputUse::kAny;
  nlohmann::ordered_json parameters() const;
  static ResonanceCurve read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

constexpr int kBeamShifts = 21;
constexpr double kLargestBeamShift = 2.5;  // position_sigma

}  // namespace beamgyro::internal
