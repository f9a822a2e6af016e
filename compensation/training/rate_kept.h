// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Returns the share of a small rate that a compensator passes in the range of
/// its training: 1 less the mean slope of its bias over the rate, for rates
/// within 1 deg/s, over the range of its temperature and of its input `rate` or
/// `output`.
///
/// A compensator file does not have the scale factor of `output`. If training
/// was at rest, only the bias moved the output, and the scale factor follows
/// from the spans of the two. Returns nothing for an input `output` with
/// training on rates, where a model cannot mistake them for bias, and for
/// compensators that use neither input.
std::optional<double> rate_kept(const FittedCompensator& compensator);

}  // namespace beamgyro::internal
