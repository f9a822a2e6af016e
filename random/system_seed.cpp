// SPDX-License-Identifier: MIT
#include "random/system_seed.h"

#include <sys/random.h>

#include <cerrno>
#include <system_error>

namespace beamgyro::internal {

std::uint64_t system_random_bits() {
  std::uint64_t bits = 0;
  // So few bytes come whole, but for a signal before the system has any.
  while (::getrandom(&bits, sizeof bits, 0) != sizeof bits)
    if (errno != EINTR)
      throw std::system_error(errno, std::generic_category(),
                              "the operating system has no random numbers");
  return bits;
}

}  // namespace beamgyro::internal
