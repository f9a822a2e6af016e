// SPDX-License-Identifier: MIT
#include "tests/fuzz/hdf5_seeds.h"

#include "dataset/netcdf/hdf5_exit.h"

namespace beamgyro::internal {

Hdf5Seeds::Hdf5Seeds(std::vector<std::string> (*make)()) {
  // What HDF5 1.10 does at its end with damage that it has met is its own.
  static const bool stays_open = (keep_hdf5_open_at_exit(), true);
  static_cast<void>(stays_open);
  for (const std::string& file : make()) {
    Seed& seed = seeds_.emplace_back();
    seed.bytes.assign(file.begin(), file.end());
    seed.sums = metadata_sums(seed.bytes);
  }
}

std::string Hdf5Seeds::file_of(std::string_view input) const {
  if (input.starts_with("\x89HDF")) return std::string(input);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(input.data());
  const std::size_t number = input.empty() ? 0 : bytes[0];
  const Seed& seed = seeds_[number % seeds_.size()];
  std::vector<std::uint8_t> changed = seed.bytes;
  if (!input.empty()) apply_patches(changed, {bytes + 1, input.size() - 1});
  mend_metadata(changed, seed.sums);
  return {changed.begin(), changed.end()};
}

}  // namespace beamgyro::internal
