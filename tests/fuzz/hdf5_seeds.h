// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/mended_hdf5.h"

namespace beamgyro::internal {

/// Valid HDF5 files that an input of a fuzzer changes. What the fuzzer makes of
/// a whole file ends at its checksums.
class Hdf5Seeds {
 public:
  /// Calls `make` for files without a checksum at their end. It is the first
  /// use of HDF5 in the process, or another Hdf5Seeds has been.
  explicit Hdf5Seeds(std::vector<std::string> (*make)());

  /// Returns the file that an input stands for: an HDF5 file is itself; of any
  /// other the first byte chooses a seed and the rest is applied to it as
  /// apply_patches() says. The sums within its metadata are mended.
  std::string file_of(std::string_view input) const;

 private:
  struct Seed {
    std::vector<std::uint8_t> bytes;
    std::vector<MetadataSum> sums;
  };
  std::vector<Seed> seeds_;
};

}  // namespace beamgyro::internal
