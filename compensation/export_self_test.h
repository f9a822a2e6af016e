// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator.h"

namespace beamgyro {

/// Samples the self-test runs through, in four power cycles of different rates.
constexpr int kGoldenSamples = 10000;
/// Of them, one in so many is compared on its own, all by their CRC-32.
constexpr int kGoldenStep = 100;

/// C99 source of main() that feeds NAME_step() with temperatures 5 K beyond the
/// range and other inputs within theirs, and compares with FirmwareModel. Exit
/// status 0 when all bits are equal. Throws as FirmwareModel.
std::string self_test_source(const Compensator& compensator,
                             const std::string& name);

}  // namespace beamgyro
