// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "sim/dynamics/gyro.h"
#include "sim/memory/memory_trajectory.h"

namespace beamgyro::internal {

/// The coefficients of (2.1) that depend on the beam's temperature, divided by
/// the modal mass: K/m [1/s2] and C/m [1/s] as xx, xy, yy; then Theta_p/m [N/(V
/// kg)] of each patch, as real and imaginary part of its component along the
/// patch's direction r_p/|r_p|.
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

/// Returns Theta_p/m [N/(V kg)] along the direction of the patch.
std::complex<double> coupling_of(const ModalChannels& channels, Patch patch);

/// Returns the exact coefficients at beam temperature T [K], which those of
/// spurious modes are no part of.
ModalChannels modal_channels(const TrimmedGyro& gyro, double T,
                             const MemoryState& memory = {});

/// Returns whether two sets of coefficients differ by less than what is worth
/// 2e-7 deg/s: a stiffness or damping force of 1e-13 of k (1e-6 of k is worth
/// 1.6 deg/s), couplings of 1e-9 of themselves.
bool are_equal(const ModalChannels& have, const ModalChannels& want);

/// The modal parameters of one gyro over beam temperature, tabulated on demand
/// by continuous cubics on cells of kModalGrid. A cell is cut where the glass
/// transition of bond or mount causes a kink. The error in the zero-rate output
/// of the nominal unit is below 1e-6 deg/s (a test compares with the exact
/// solution). Not safe for use by two threads at once.
class ModalTable {
 public:
  explicit ModalTable(const TrimmedGyro& gyro);

  struct Point {
    ModalChannels value, slope;  // slope per K
  };
  /// Returns the coefficients at beam temperature T [K] and their slopes.
  /// Throws SimulationFailure outside kColdestBeam .. kHottestBeam.
  Point at(double T);

  const PerPatch<Eigen::Vector2d>& direction() const { return direction_; }

 private:
  // Coefficients of the powers 0 .. 3 of the position within one of equal parts
  // of a cell.
  using Cubic = std::array<ModalChannels, 4>;
  Cubic cubic(double left, double right) const;
  bool accurate(const Cubic& cubic, double left, double right) const;
  const std::vector<Cubic>& cell(std::size_t i);

  TrimmedGyro gyro_;
  PerPatch<Eigen::Vector2d> direction_;
  std::vector<std::vector<Cubic>> cells_;  // empty until needed
};

inline constexpr double kModalGrid = 0.25;      // [K]
inline constexpr double kColdestBeam = 173.15;  // [K]
inline constexpr double kHottestBeam = 473.15;  // [K]

/// What the memory of one unit adds to the coefficients of its ModalTable over
/// a run. At each knot of the trajectory it is the difference of the exact
/// parameters with and without memory, and it is cubic in time between knots.
/// It is linear in the hysteresis between 0 and the extreme of its sign: what
/// is left out is worth less than 1e-5 deg/s for a turn of the mount's axis of
/// 0.02 deg.
class ModalMemory {
 public:
  /// The trajectory must outlive the object.
  ModalMemory(const TrimmedGyro& gyro, const MemoryTrajectory& memory);

  /// The coefficients to add at time `t` [s] with the beam at `beam` [K].
  /// `interval` is where the last call found its knots, and 0 at first.
  ModalChannels at(double t, double beam, std::size_t& interval) const;

  /// The states at time `t` [s] with the beam at `beam` [K].
  MemoryState state(double t, double beam) const { return memory_.at(t, beam); }

 private:
  const MemoryTrajectory& memory_;
  SmoothCourse<ModalChannels> without_hysteresis_, per_hysteresis_;
};

}  // namespace beamgyro::internal
