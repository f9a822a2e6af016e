// SPDX-License-Identifier: MIT
#include "dataset/files/hdf5_signature.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace beamgyro::internal {

namespace {

constexpr std::string_view kFirstBytes = "\x89HDF\r\n\x1a\n";

}  // namespace

bool is_hdf5_file(OpenFile& file) {
  constexpr std::uint64_t kFirst = 512;  // possible end of a block of the user
  std::array<std::byte, kFirstBytes.size()> bytes{};
  for (std::uint64_t place = 0; file.read_at(place, bytes) == bytes.size();) {
    if (std::memcmp(bytes.data(), kFirstBytes.data(), bytes.size()) == 0)
      return true;
    place = place == 0 ? kFirst : 2 * place;
  }
  return false;
}

// "Superblock" of the HDF5 File Format Specification 3.0: an address behind the
// last byte, counted from a base that stands 16 bytes before it.
std::uint64_t stated_hdf5_size(OpenFile& file) {
  std::array<std::byte, 56> bytes{};
  if (file.read_at(0, bytes) < bytes.size() ||
      std::memcmp(bytes.data(), kFirstBytes.data(), kFirstBytes.size()) != 0)
    return 0;
  const auto number_at = [&](std::size_t place, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;)
      value = value << 8 | std::to_integer<std::uint64_t>(bytes[place + i]);
    return value;
  };
  const std::uint64_t version = number_at(8, 1);
  const std::size_t address_bytes = number_at(version < 2 ? 13 : 9, 1);
  if (version > 3 || address_bytes != 8) return 0;
  const std::size_t base = version == 0   ? 24
                           : version == 1 ? 28
                                          : 12;  // [byte]
  return number_at(base, 8) == 0 ? number_at(base + 16, 8) : 0;
}

}  // namespace beamgyro::internal
