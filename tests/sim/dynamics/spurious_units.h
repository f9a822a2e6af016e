// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "sim/dynamics/gyro.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal {

/// One spurious mode of the nominal unit with beam.angular_gain = 1, for which
/// the values of V60 to V63 were computed.
struct SpuriousUnit {
  double crossing;  // T_c [degC]
  double detuning, detuning_tc, loss_factor, coupling_drive, coupling_sense;

  /// The mode as overrides of a device file.
  std::vector<std::string> overrides() const {
    const auto set = [](const char* key, double value) {
      return fmt::format("spurious_mode.wire.{}={}", key, value);
    };
    return {set("detuning", detuning), set("detuning_tc_per_K", detuning_tc),
            set("loss_factor", loss_factor),
            set("coupling_drive", coupling_drive),
            set("coupling_sense", coupling_sense)};
  }
  TrimmedGyro gyro() const {
    return make_gyro(verification_device(overrides()));
  }
};

inline constexpr SpuriousUnit kUnitA{5,    -4.720732e-3, -2.5e-4,
                                     1e-3, 2e-5,         2e-5};
inline constexpr SpuriousUnit kUnitB{-20, 1.874215e-2, 4e-4, 2e-3, 6e-5, -1e-5};
inline constexpr SpuriousUnit kUnitC{30, 4.936776e-3, -1e-3, 1e-3, 1e-4, 1e-4};

}  // namespace beamgyro::internal
