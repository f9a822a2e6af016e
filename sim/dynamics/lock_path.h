// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sim/dynamics/static_solution.h"

namespace beamgyro {

struct Gyro;

/// The frequency at which one gyro's drive loop locks at rest, followed from
/// T_0 to other beam temperatures: of several stable locks it tells which one
/// continues that of T_0. Filled on demand, for one gyro; not safe for use by
/// two threads at once.
class LockPath {
 public:
  /// w_d at beam temperature `T` [K] in rad/s; 0 where the lock of T_0 ends
  /// before.
  double at(const Gyro& gyro, double T);

 private:
  std::vector<double> colder_, warmer_;  // at T_0 -+ k steps; 0: ended
};

/// static_solution() at `modal`; of several stable locks the one nearest to
/// `guess` [rad/s] or, with 0, the one that continues that of T_0 as `path` of
/// this gyro knows it. Where none does, the one of the lowest voltage.
StaticSolution static_solution(const Gyro& gyro, const ModalParameters& modal,
                               const CaseMotion& motion, LockPath& path,
                               double guess = 0);
StaticSolution static_solution(const Gyro& gyro, const ModalParameters& modal,
                               const CaseMotion& motion, double guess = 0);

}  // namespace beamgyro
