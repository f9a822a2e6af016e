// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator/compensator.h"
#include "compensation/export/firmware_model.h"

namespace beamgyro::internal {

/// Returns the C source that makes NAME.c a library of beamgyro/plugin.h, with
/// the runs that the compensator was trained on. It needs no header but NAME.h
/// and those of C.
std::string plugin_source(const FittedCompensator& compensator,
                          const std::string& name, const FirmwareModel& model);

}  // namespace beamgyro::internal
