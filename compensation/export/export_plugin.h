// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/export/firmware_model.h"

namespace beamgyro::internal {

/// Returns the C source that makes NAME.c a library of beamgyro/plugin.h. It
/// needs no header but NAME.h and those of C.
std::string plugin_source(const std::string& name, const FirmwareModel& model);

}  // namespace beamgyro::internal
