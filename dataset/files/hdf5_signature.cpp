// SPDX-License-Identifier: MIT
#include "dataset/files/hdf5_signature.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace beamgyro::internal {

bool is_hdf5_file(OpenFile& file) {
  constexpr std::uint64_t kFirst = 512;  // possible end of a block of the user
  std::array<std::byte, kHdf5Signature.size()> bytes{};
  for (std::uint64_t place = 0; file.read_at(place, bytes) == bytes.size();) {
    if (std::memcmp(bytes.data(), kHdf5Signature.data(), bytes.size()) == 0)
      return true;
    place = place == 0 ? kFirst : 2 * place;
  }
  return false;
}

}  // namespace beamgyro::internal
