// SPDX-License-Identifier: MIT
#include "dataset/set/shard/hdf5_image.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "dataset/netcdf/hdf5_write.h"

namespace beamgyro::internal {

H5Id make_image() {
  constexpr std::size_t kIncrement = std::size_t{1} << 20;  // [byte]
  const H5Id access = access_properties();
  check_hdf5(H5Pset_fapl_core(access, kIncrement, false), "stay in memory");
  // HDF5 looks for a file of this name first, and tells open files apart by it.
  static std::atomic<std::uint64_t> count{0};
  const std::string name = fmt::format("/dev/null/image-{}", count++);
  return {H5Fcreate(name.c_str(), H5F_ACC_TRUNC,
                    creation_properties(H5P_FILE_CREATE), access),
          H5Fclose, "create the file"};
}

std::span<const std::byte> image_bytes(const H5Id& file) {
  check_hdf5(H5Fflush(file, H5F_SCOPE_GLOBAL), "complete the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check_hdf5(size < 0 ? -1 : 0, "size the file");
  void* handle = nullptr;
  check_hdf5(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle), "find the file");
  return {*static_cast<const std::byte* const*>(handle),
          static_cast<std::size_t>(size)};
}

}  // namespace beamgyro::internal
