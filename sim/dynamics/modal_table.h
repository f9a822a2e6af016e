// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "sim/dynamics/gyro.h"

namespace beamgyro {

/// What of (2.1) moves with the beam temperature, per mass: K/m [1/s2] and C/m
/// [1/s] as xx, xy, yy, then Theta_p/m [N/(V kg)] of each patch as the real and
/// imaginary part of its component along the patch's own direction r_p/|r_p|.
enum ModalChannel {
  kStiffnessXx,
  kStiffnessXy,
  kStiffnessYy,
  kDampingXx,
  kDampingXy,
  kDampingYy,
  kCouplings,
  kModalChannelCount = kCouplings + 2 * kPatchCount
};
using ModalChannels = Eigen::Array<double, kModalChannelCount, 1>;

Eigen::Matrix2d stiffness_of(const ModalChannels& channels);  // K/m [1/s2]
Eigen::Matrix2d damping_of(const ModalChannels& channels);    // C/m [1/s]

/// Theta_p/m along the patch's direction [N/(V kg)].
std::complex<double> coupling_of(const ModalChannels& channels, Patch patch);

/// The modal parameters of one gyro over beam temperature, tabulated on demand:
/// continuous cubics on cells of kModalGrid, which are cut where the glass
/// transition of bond or mount puts a kink inside. The error in the zero-rate
/// output of the nominal unit is below 1e-6 deg/s (a test holds it against the
/// exact solution).
class ModalTable {
 public:
  explicit ModalTable(const Gyro& gyro);

  struct Point {
    ModalChannels value, slope;  // slope per K
  };
  /// At beam temperature T [K]. Throws SimulationFailure outside
  /// kColdestBeam .. kHottestBeam.
  Point at(double T);

  /// `channels` as matrices again.
  ModalParameters parameters(const ModalChannels& channels) const;

  const PerPatch<Eigen::Vector2d>& direction() const { return direction_; }

 private:
  // Powers 0 .. 3 of the place within one of equal parts of a cell.
  using Cubic = std::array<ModalChannels, 4>;
  ModalChannels exact(double T) const;
  Cubic cubic(double left, double right) const;
  bool accurate(const Cubic& cubic, double left, double right) const;
  const std::vector<Cubic>& cell(std::size_t i);

  Gyro gyro_;
  double mass_, coriolis_mass_;
  PerPatch<Eigen::Vector2d> direction_;
  std::vector<std::vector<Cubic>> cells_;  // empty until needed
};

inline constexpr double kModalGrid = 0.25;      // [K]
inline constexpr double kColdestBeam = 173.15;  // [K]
inline constexpr double kHottestBeam = 473.15;  // [K]

}  // namespace beamgyro
