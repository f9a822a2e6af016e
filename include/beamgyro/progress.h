// SPDX-License-Identifier: MIT
/// \file
/// Progress and cancellation of long calls.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>

#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// Takes the share of the work that is done, 0 .. 1, and returns whether to go
/// on. It is called from any thread, but never by two at once. An empty
/// function asks for nothing. An exception that it throws ends the work, too,
/// and reaches the caller.
using Progress = std::function<bool(double share)>;

/// How far the training of a network is.
struct TrainingProgress {
  std::size_t restart = 0, restarts = 0;
  std::size_t epoch = 0, max_epochs = 0;
  double rms = 0;  ///< [deg/s], over the training rows
};

/// Thrown where a Progress returned false. Nothing that was under way is left
/// under its final name; the finished files of a set stay.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace beamgyro
