// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tests/compensation/recorded_run.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// A run at 100 Hz at a changing rate, with the power off from 9 s to 9.5 s.
Recording tested_run(double duration = 10.0);

/// For a host that is instrumented without a limit of memory, which the shadow
/// memory of a sanitizer exceeds.
ProcessLimits test_limits();

/// Opens a library of faulty_plugin.c by the name of its fault.
std::shared_ptr<const TestedCompensator> faulty_plugin(
    const std::string& fault);

/// Returns the only fault of the answers to a run; expects it to be the only
/// one.
SeenFault only_fault(const TestedCompensator& compensator,
                     const Recording& run = tested_run());

}  // namespace beamgyro::internal
