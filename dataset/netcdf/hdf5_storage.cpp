// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_storage.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "dataset/netcdf/hdf5_id.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint64_t kMostInflated = 1032;  // deflate packs no tighter

[[noreturn]] void missing(const std::string& name) {
  throw Hdf5Error(fmt::format("the values of {} are missing", name));
}

[[noreturn]] void too_large(const std::string& name, std::uint64_t claimed,
                            std::uint64_t there) {
  throw Hdf5Error(
      fmt::format("{} claims {} bytes of values, and the file has {} for them",
                  name, claimed, there));
}

/// The product, or the largest number when it is larger.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result)
             ? std::numeric_limits<std::uint64_t>::max()
             : result;
}

std::uint64_t size_of_file(hid_t variable) {
  const H5Id file(H5Iget_file_id(variable), H5Fclose, "find the file");
  hsize_t size = 0;
  check_hdf5(H5Fget_filesize(file, &size), "size the file");
  return size;
}

/// Returns the size of the values in the file [bytes]. The library also returns
/// 0 when it cannot determine it.
std::uint64_t stored_size(hid_t variable, const std::string& name) {
  const hsize_t size = H5Dget_storage_size(variable);
  const bool failed = size == 0 && H5Eget_num(H5E_DEFAULT) > 0;
  check_hdf5(failed ? -1 : 0, "size " + name);
  return size;
}

/// Whether one of the filters is deflate.
bool is_deflated(hid_t properties, const std::string& name) {
  const int count = H5Pget_nfilters(properties);
  check_hdf5(count < 0 ? -1 : 0, "read the filters of " + name);
  std::set<H5Z_filter_t> met;
  for (int k = 0; k < count; ++k) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, static_cast<unsigned>(k), &flags, &values,
                       nullptr, 0, nullptr, nullptr);
    check_hdf5(filter < 0 ? -1 : 0, "read the filters of " + name);
    if ((filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE &&
         filter != H5Z_FILTER_FLETCHER32) ||
        !met.insert(filter).second)
      throw Hdf5Error(fmt::format(
          "{} is stored through filter {}; expected shuffle, deflate and "
          "fletcher32, each once at most",
          name, filter));
  }
  return met.contains(H5Z_FILTER_DEFLATE);
}

/// Checks a chunked variable of values of `width` bytes: every chunk is there
/// and large enough.
void check_chunks(hid_t variable, hid_t properties, const std::string& name,
                  const std::vector<hsize_t>& lengths, std::size_t width,
                  std::uint64_t stored) {
  std::vector<hsize_t> chunk(lengths.size());
  const int rank = static_cast<int>(lengths.size());
  if (H5Pget_chunk(properties, rank, chunk.data()) != rank)
    throw Hdf5Error(fmt::format("{} has chunks of another shape", name));
  std::uint64_t chunks = 1, size = width;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (chunk[i] == 0) missing(name);
    chunks =
        product(chunks, lengths[i] / chunk[i] + (lengths[i] % chunk[i] != 0));
    size = product(size, chunk[i]);
  }
  const std::uint64_t claimed = product(chunks, size);
  const bool deflated = is_deflated(properties, name);
  if (claimed > (deflated ? product(stored, kMostInflated) : stored))
    too_large(name, claimed, stored);
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  hsize_t there = 0;
  check_hdf5(H5Dget_num_chunks(variable, space, &there), "size " + name);
  if (there != chunks) missing(name);
}

}  // namespace

void reject_view(const std::string& name) {
  throw Hdf5Error(
      fmt::format("{} is a view of other files, which does not tell missing "
                  "files from missing values; expected the values",
                  name));
}

void check_storage(hid_t variable, const std::string& name) {
  const H5Id properties(H5Dget_create_plist(variable), H5Pclose,
                        "open " + name);
  const H5D_layout_t layout = H5Pget_layout(properties);
  if (layout == H5D_VIRTUAL) reject_view(name);
  const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  const int rank = H5Sget_simple_extent_ndims(space);
  check_hdf5(rank, "size " + name);
  std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
  check_hdf5(H5Sget_simple_extent_dims(space, lengths.data(), nullptr),
             "size " + name);
  const std::size_t width = H5Tget_size(type);
  check_hdf5(width == 0 ? -1 : 0, "size " + name);
  std::uint64_t claimed = width;
  for (const hsize_t length : lengths) claimed = product(claimed, length);

  const int external = H5Pget_external_count(properties);
  check_hdf5(external, "open " + name);
  if (external > 0)
    throw Hdf5Error(fmt::format(
        "the values of {} are in another file; expected them in this", name));
  const std::uint64_t file = size_of_file(variable);
  const std::uint64_t stored = stored_size(variable, name);
  if (stored > file) too_large(name, stored, file);
  if (claimed == 0) return;
  switch (layout) {
    case H5D_CHUNKED:
      return check_chunks(variable, properties, name, lengths, width, stored);
    case H5D_CONTIGUOUS: {
      const haddr_t place = H5Dget_offset(variable);
      if (place == HADDR_UNDEF) missing(name);
      if (claimed > file || place > file - claimed)
        too_large(name, claimed, file);
      [[fallthrough]];
    }
    case H5D_COMPACT:
      if (claimed > stored) missing(name);
      return;
    default:
      throw Hdf5Error(fmt::format("{} is stored in an unknown way", name));
  }
}

}  // namespace beamgyro::internal
