// SPDX-License-Identifier: MIT
#include "dataset/netcdf/inflate.h"

#include <libdeflate.h>

#include <memory>
#include <new>
#include <vector>

namespace beamgyro::internal {

bool inflates_to(std::span<const std::byte> packed, std::size_t size) {
  const std::unique_ptr<libdeflate_decompressor,
                        void (*)(libdeflate_decompressor*)>
      inflate(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (inflate == nullptr) throw std::bad_alloc();
  std::vector<std::byte> bytes(size);
  return libdeflate_zlib_decompress(inflate.get(), packed.data(), packed.size(),
                                    bytes.data(), bytes.size(),
                                    nullptr) == LIBDEFLATE_SUCCESS;
}

}  // namespace beamgyro::internal
