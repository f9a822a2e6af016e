// SPDX-License-Identifier: MIT
#include "validation/external/tested_compensator.h"

#include <utility>

namespace beamgyro::internal {

Answer TestedCompensator::answer(const Recording& run) const {
  return std::move(answers({&run}).front());
}

}  // namespace beamgyro::internal
