// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/training/train.h"

namespace beamgyro::internal {

/// Returns what a training chose and what it leaves, line by line; with
/// `every_group` also each group of the cross-validation.
std::string training_report(const TrainResult& result, bool every_group);

}  // namespace beamgyro::internal
