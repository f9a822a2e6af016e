// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "validation/qualification/qualification.h"

namespace beamgyro::internal {

/// Returns a qualification as a seed draws it
/// (docs/reference/qualification_file.md): every run has another seed of its
/// noise, the values of its `vary`, and the runs to judge another order. The
/// drawn values stand among the overrides of a run. A draw depends on the seed
/// and on names alone. Throws std::invalid_argument for a drawn value that a
/// scenario does not take.
Qualification drawn_qualification(const Qualification& stated,
                                  std::uint64_t seed);

/// Returns the seed of a campaign whose devices are drawn, too.
std::uint64_t drawn_campaign_seed(std::uint64_t seed);

}  // namespace beamgyro::internal
