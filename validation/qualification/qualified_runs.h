// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"
#include "sim/device/device.h"
#include "validation/qualification/qualification.h"

namespace beamgyro::internal {

/// A device that goes through a qualification.
struct QualifiedDevice {
  DeviceParameters device;
  std::string text;            // of the device file, byte for byte
  std::string overrides = {};  // KEY=VALUE lines that make it of that text
  std::uint32_t number = 0;    // selects its random streams
};

/// Returns the recordings of the runs in their order, simulated on `threads`
/// threads. The recording of a run is the one that `run` makes of its scenario
/// and overrides with this device. Calls `on_done`, if there is one, after each
/// run, from any thread. Throws SimulationFailure that names the run, and as
/// make_gyro().
std::vector<Recording> qualified_runs(
    const std::vector<QualificationRun>& runs, const QualifiedDevice& device,
    std::size_t threads, const std::function<void()>& on_done = {});

}  // namespace beamgyro::internal
