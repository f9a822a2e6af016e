// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace beamgyro::internal {

/// The axes of the case: rates about z, the input axis, and about x and y, then
/// accelerations.
enum CaseAxis : std::size_t {
  kRateZ,
  kRateX,
  kRateY,
  kAccelerationX,
  kAccelerationY,
  kAccelerationZ,
  kCaseAxisCount
};
template <class T>
using PerAxis = std::array<T, kCaseAxisCount>;

}  // namespace beamgyro::internal
