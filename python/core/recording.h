// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "include/beamgyro/recording.h"

namespace beamgyro::python {

using SharedRecording = std::shared_ptr<Recording>;

/// Returns (recording, warnings).
pybind11::tuple with_warnings(Recording&& recording,
                              const std::vector<std::string>& warnings);

}  // namespace beamgyro::python
