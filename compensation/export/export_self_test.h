// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Number of samples of the self-test, in four power cycles with different
/// sample rates.
constexpr int kGoldenSamples = 10000;
/// One sample in so many is compared by itself, all of them by their CRC-32.
constexpr int kGoldenStep = 100;

/// Returns the C99 source of main(). It calls NAME_step() with temperatures up
/// to 5 K beyond the range and with other inputs within theirs, and compares
/// with FirmwareModel. Its exit status is 0 when all bits are equal. Throws as
/// FirmwareModel.
std::string self_test_source(const FittedCompensator& compensator,
                             const std::string& name);

}  // namespace beamgyro::internal
