// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/dynamics/static_solution.h"

namespace beamgyro::internal {

struct Gyro;

/// The frequency at which the drive loop of one gyro locks at rest, followed
/// from T_0 to other beam temperatures. Where there are several stable locks it
/// says which of them continues the lock at T_0. The path is computed on
/// demand. Use one object for one gyro only, and in one thread at a time.
class LockPath {
 public:
  /// Returns w_d [rad/s] at beam temperature `T` [K], or 0 when the lock of T_0
  /// ends before T.
  double at(const Gyro& gyro, double T);

 private:
  std::vector<double> colder_, warmer_;  // at T_0 -+ k steps; 0: ended
};

/// Returns static_solution() at `modal`. Of several stable locks it takes the
/// one nearest to `guess` [rad/s]. If `guess` is 0 it takes the one that
/// continues the lock at T_0 according to `path`, or where none does, the one
/// with the lowest voltage.
StaticSolution static_solution(const Gyro& gyro, const ModalParameters& modal,
                               const CaseMotion& motion, LockPath& path,
                               double guess = 0);
StaticSolution static_solution(const Gyro& gyro, const ModalParameters& modal,
                               const CaseMotion& motion, double guess = 0);

}  // namespace beamgyro::internal
