// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

inline constexpr double kGasConstant = 8.314462618;  // [J/(mol K)]

}  // namespace beamgyro::internal
