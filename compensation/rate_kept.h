// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "compensation/compensator.h"

namespace beamgyro {

/// Share of a small rate that a compensator lets through where it was trained:
/// 1 less the mean slope of its bias over the rate, for rates within 1 deg/s,
/// over the range of its temperature and of its input `rate` or `output`.
///
/// A file does not tell the volts that `output` shows for a rate. Trained at
/// rest, where nothing but the bias moved the output, they follow from the
/// spans of the two. Trained on rates, a model cannot take them for bias:
/// nothing is answered for an input `output` then, and for compensators that
/// look at neither input.
std::optional<double> rate_kept(const Compensator& compensator);

}  // namespace beamgyro
