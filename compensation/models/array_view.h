// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamgyro::internal {

/// Returns the values as an array of Eigen, without copying them. They must
/// outlive it.
template <class Value>
Eigen::Map<const Eigen::ArrayX<Value>> array_view(
    const std::vector<Value>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace beamgyro::internal
