// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_storage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/inflate.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint64_t kSumBytes = 4;         // of fletcher32
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

[[noreturn]] void too_much(const std::string& what, std::uint64_t claimed,
                           std::uint64_t room) {
  throw Hdf5Error(fmt::format(
      "{} takes {} bytes of memory, more than the {} bytes that a file of its "
      "size may ask for",
      what, claimed, room));
}

/// The product, or the largest number when it is larger.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result)
             ? std::numeric_limits<std::uint64_t>::max()
             : result;
}

std::uint64_t size_of_file(hid_t file) {
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

/// The filters that chunks pass, each once at most, as bits of their places.
using Filters = std::map<H5Z_filter_t, unsigned>;

Filters filters_of(hid_t properties, const std::string& name) {
  const int count = H5Pget_nfilters(properties);
  check_hdf5(count < 0 ? -1 : 0, "read the filters of " + name);
  Filters met;
  for (int k = 0; k < count; ++k) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, static_cast<unsigned>(k), &flags, &values,
                       nullptr, 0, nullptr, nullptr);
    check_hdf5(filter < 0 ? -1 : 0, "read the filters of " + name);
    if ((filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE &&
         filter != H5Z_FILTER_FLETCHER32) ||
        !met.emplace(filter, 1u << k).second)
      throw Hdf5Error(fmt::format(
          "{} is stored through filter {}; expected shuffle, deflate and "
          "fletcher32, each once at most",
          name, filter));
  }
  return met;
}

/// Throws unless `packed` bytes of the chunk at `place`, of `stored` in all,
/// inflate to `size` bytes. HDF5 reads one that inflates to less beyond its
/// end.
void check_inflated(hid_t variable, const std::string& name,
                    const hsize_t* place, std::uint64_t stored,
                    std::uint64_t packed, std::uint64_t size) {
  constexpr std::uint64_t kMostStored = 1024;  // more than is deflated
  bool is_whole = packed <= stored && stored <= product(size, 2) + kMostStored;
  if (is_whole) {
    std::vector<std::byte> bytes(stored);
    std::uint32_t skipped_filters = 0;
    check_hdf5(H5Dread_chunk(variable, H5P_DEFAULT, place, &skipped_filters,
                             bytes.data()),
               "read " + name);
    is_whole = inflates_to(std::span(bytes).first(packed), size);
  }
  if (!is_whole)
    throw Hdf5Error(
        fmt::format("a chunk of {} does not inflate to {} bytes", name, size));
}

/// Checks a chunked variable of values of `width` bytes: every chunk is there
/// and large enough.
void check_chunks(hid_t variable, hid_t properties, const std::string& name,
                  const std::vector<hsize_t>& lengths, std::size_t width,
                  std::uint64_t stored, std::uint64_t room) {
  constexpr std::uint64_t kShare = 8;  // HDF5 holds some copies of a chunk
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
  if (size > room / kShare)
    too_much(fmt::format("a chunk of {}", name), size, room / kShare);
  const std::uint64_t claimed = product(chunks, size);
  const bool deflated =
      filters_of(properties, name).contains(H5Z_FILTER_DEFLATE);
  if (claimed > (deflated ? product(stored, kMostInflated) : stored))
    too_large(name, claimed, stored);
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  hsize_t there = 0;
  check_hdf5(H5Dget_num_chunks(variable, space, &there), "size " + name);
  if (there != chunks) missing(name);
}

}  // namespace

void check_chunks_of_row(hid_t variable, const std::string& name, hsize_t row) {
  const H5Id properties(H5Dget_create_plist(variable), H5Pclose,
                        "open " + name);
  if (H5Pget_layout(properties) != H5D_CHUNKED) return;
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  std::array<hsize_t, 2> length{}, chunk{};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2 || H5Pget_chunk(properties, 2, chunk.data()) != rank)
    throw Hdf5Error(fmt::format("{} has chunks of another shape", name));
  check_hdf5(H5Sget_simple_extent_dims(space, length.data(), nullptr),
             "size " + name);
  const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
  std::uint64_t size = product(H5Tget_size(type), chunk[0]);
  if (rank == 2) size = product(size, chunk[1]);
  const std::size_t along = rank == 2 ? 1 : 0;
  if (rank == 1) {
    const H5Id file(H5Iget_file_id(variable), H5Fclose, "find the file");
    const std::uint64_t all = product(H5Tget_size(type), length[0]);
    if (const std::uint64_t room = room_for_values(file); all > room)
      too_much(name, all, room);
  }
  const Filters filters = filters_of(properties, name);
  std::array<hsize_t, 2> place{};
  if (rank == 2) place[0] = row - row % chunk[0];
  for (; place.at(along) < length.at(along);
       place.at(along) += chunk.at(along)) {
    unsigned skipped_filters = 0;
    haddr_t address = 0;
    hsize_t stored = 0;
    check_hdf5(H5Dget_chunk_info_by_coord(variable, place.data(),
                                          &skipped_filters, &address, &stored),
               "size " + name);
    // HDF5 reads a chunk that is smaller than it claims beyond its end.
    const auto passed = [&](H5Z_filter_t filter) {
      const auto met = filters.find(filter);
      return met != filters.end() && (met->second & skipped_filters) == 0;
    };
    const std::uint64_t sum = passed(H5Z_FILTER_FLETCHER32) ? kSumBytes : 0;
    if (!passed(H5Z_FILTER_DEFLATE)) {
      if (stored < size + sum) too_large(name, size, stored);
      continue;
    }
    // A sum that comes after deflate is beside what that has packed.
    const std::uint64_t beside = sum > 0 && filters.at(H5Z_FILTER_FLETCHER32) >
                                                filters.at(H5Z_FILTER_DEFLATE)
                                     ? sum
                                     : 0;
    check_inflated(variable, name, place.data(), stored, stored - beside,
                   size + sum - beside);
  }
}

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
  const H5Id its_file(H5Iget_file_id(variable), H5Fclose, "find the file");
  const std::uint64_t file = size_of_file(its_file);
  const std::uint64_t stored = stored_size(variable, name);
  if (stored > file) too_large(name, stored, file);
  if (claimed == 0) return;
  const std::uint64_t room = room_for_values(its_file);
  switch (layout) {
    case H5D_CHUNKED:
      return check_chunks(variable, properties, name, lengths, width, stored,
                          room);
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

std::uint64_t room_for_values(hid_t file) {
  // A small file may be a bomb. A large one may be a run without noise, which
  // deflates well.
  constexpr std::uint64_t kAlways = 32u << 20, kSmall = 4u << 20;
  constexpr std::uint64_t kOfSmall = 64, kOfLarge = 400;
  const std::uint64_t size = size_of_file(file);
  const std::uint64_t small = std::min(size, kSmall);
  return kAlways + kOfSmall * small + kOfLarge * (size - small);
}

}  // namespace beamgyro::internal
