// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <system_error>
#include <utility>

#include "dataset/files/hdf5_signature.h"
#include "dataset/netcdf/hdf5_bytes.h"
#include "dataset/netcdf/hdf5_header.h"
#include "dataset/netcdf/hdf5_heap.h"
#include "dataset/netcdf/hdf5_tree.h"
#include "dataset/netcdf/hdf5_write.h"

namespace beamgyro::internal {
namespace {

constexpr haddr_t kLargest = std::numeric_limits<off_t>::max();

/// Data that HDF5 passes to the driver in its properties.
struct DriverInfo {
  OpenFile* file;
};

/// HDF5 requires its own structure at the beginning.
struct DrivenFile {
  H5FD_t for_hdf5{};
  OpenFile* file = nullptr;
  bool is_read_only = true;
  int failed_write = 0;  // errno of the first one
  haddr_t end_of_addresses = 0, size = 0;
  ObjectHeaders headers{};
};

DrivenFile& driven(const H5FD_t* file) {
  return *reinterpret_cast<DrivenFile*>(const_cast<H5FD_t*>(file));
}

bool met_global_heap = false;
// QuietHdf5 keeps other threads out.
int failed_call = 0;        // errno
bool write_failed = false;  // since failed_call was taken last

/// No exception may pass through the library.
template <class Work>
herr_t guarded(const Work& work) noexcept {
  try {
    work();
    return 0;
  } catch (const std::system_error& error) {
    if (failed_call == 0) failed_call = error.code().value();
  } catch (const std::exception&) {
    if (failed_call == 0) failed_call = ENOMEM;
  }
  return -1;
}

/// The same for work that writes. HDF5 learns of no failure, and what it writes
/// afterwards goes nowhere: a file that HDF5 1.10 could not write stays half
/// closed in the library, which crashes at the end of the process. The caller
/// learns of it by check_hdf5().
template <class Work>
void write_guarded(DrivenFile& to, const Work& work) noexcept {
  if (to.failed_write == 0 && guarded(work) == 0) return;
  if (to.failed_write == 0) to.failed_write = failed_call;
  failed_call = to.failed_write;
  write_failed = true;
}

H5FD_t* open_driven(const char*, unsigned flags, hid_t properties, haddr_t) {
  const auto* info =
      static_cast<const DriverInfo*>(H5Pget_driver_info(properties));
  if (info == nullptr) return nullptr;
  DrivenFile* opened = nullptr;
  guarded([&] {
    if ((flags & H5F_ACC_TRUNC) != 0) info->file->resize(0);
    auto made = std::make_unique<DrivenFile>();
    made->file = info->file;
    made->is_read_only = (flags & H5F_ACC_RDWR) == 0;
    made->size = info->file->size();
    opened = made.release();
  });
  return opened == nullptr ? nullptr : &opened->for_hdf5;
}

herr_t close_driven(H5FD_t* file) {
  if (const int error = driven(file).failed_write; error != 0) {
    failed_call = error;
    write_failed = true;
  }
  delete &driven(file);
  return 0;
}

herr_t query_driven(const H5FD_t* file, unsigned long* features) {
  constexpr unsigned long kAlways =
      H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_DATA_SIEVE |
      H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  // Written files have the layout that the library's own driver gives them. In
  // a file that is only read a damaged address crashes the accumulator of HDF5
  // 1.10, and a damaged block of driver information takes 4 GiB.
  const bool is_read = file != nullptr && driven(file).is_read_only;
  *features = kAlways | (is_read ? H5FD_FEAT_IGNORE_DRVRINFO
                                 : H5FD_FEAT_ACCUMULATE_METADATA);
  return 0;
}

haddr_t end_of_addresses(const H5FD_t* file, H5FD_mem_t) {
  return driven(file).end_of_addresses;
}

herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  driven(file).end_of_addresses = end;
  return 0;
}

haddr_t size_of_driven(const H5FD_t* file, H5FD_mem_t) {
  return driven(file).size;
}

bool is_beyond(haddr_t place, std::size_t size) {
  return place > kLargest || size > kLargest - place;
}

/// Returns whether these are the first bytes of a global heap. HDF5 1.10 does
/// not check it: damage there crashes or hangs the library.
bool is_global_heap(std::span<const std::byte> bytes) {
  return starts_with(bytes, "GCOL\x01");
}

/// Reads from a file that is not written, where no bytes beyond its end are
/// made up.
herr_t read_strictly(DrivenFile& from, H5FD_mem_t kind, haddr_t place,
                     std::span<std::byte> bytes) {
  const auto fill = [&from](haddr_t start, std::span<std::byte> part) {
    return start <= from.size && part.size() <= from.size - start &&
           from.file->read_at(start, part) == part.size();
  };
  bool is_sound = false;
  const herr_t status = guarded([&] {
    is_sound = fill(place, bytes) && is_sound_heap(bytes) &&
               is_sound_chunk_node(bytes) &&
               (!is_tree(bytes) || is_sound_tree(bytes, from.size, fill)) &&
               from.headers.are_sound(place, bytes, kind == H5FD_MEM_OHDR,
                                      from.size, fill);
  });
  if (status < 0 || !is_sound) return -1;
  if (!is_global_heap(bytes)) return 0;
  met_global_heap = true;
  return -1;
}

herr_t read_driven(H5FD_t* file, H5FD_mem_t kind, hid_t, haddr_t place,
                   std::size_t size, void* buffer) {
  DrivenFile& from = driven(file);
  const std::span bytes(static_cast<std::byte*>(buffer), size);
  if (from.is_read_only) return read_strictly(from, kind, place, bytes);
  if (is_beyond(place, size)) return -1;
  return guarded([&] {
    const std::size_t there = from.file->read_at(place, bytes);
    std::ranges::fill(bytes.subspan(there), std::byte{0});
  });
}

herr_t write_driven(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t place,
                    std::size_t size, const void* buffer) {
  if (is_beyond(place, size)) return -1;
  DrivenFile& to = driven(file);
  write_guarded(to, [&] {
    to.file->write_at(place, {static_cast<const std::byte*>(buffer), size});
  });
  to.size = std::max<haddr_t>(to.size, place + size);
  return 0;
}

herr_t truncate_driven(H5FD_t* file, hid_t, hbool_t) {
  DrivenFile& to = driven(file);
  if (to.size == to.end_of_addresses) return 0;
  write_guarded(to, [&] { to.file->resize(to.end_of_addresses); });
  to.size = to.end_of_addresses;
  return 0;
}

hid_t driver() {
  static const hid_t id = [] {
    H5FD_class_t about{};
    about.name = "beamgyro";
    about.maxaddr = kLargest;
    about.fc_degree = H5F_CLOSE_WEAK;
    about.fapl_size = sizeof(DriverInfo);
    about.open = open_driven;
    about.close = close_driven;
    about.query = query_driven;
    about.get_eoa = end_of_addresses;
    about.set_eoa = set_end_of_addresses;
    about.get_eof = size_of_driven;
    about.read = read_driven;
    about.write = write_driven;
    about.truncate = truncate_driven;
    constexpr std::array<H5FD_mem_t, H5FD_MEM_NTYPES> kMap =
        H5FD_FLMAP_DICHOTOMY;
    std::ranges::copy(kMap, about.fl_map);
    const hid_t registered = H5FDregister(&about);
    check_hdf5(registered < 0 ? -1 : 0, "start HDF5");
    return registered;
  }();
  return id;
}

H5Id properties_for(OpenFile& file) {
  H5Id access = access_properties();
  const DriverInfo info{&file};
  check_hdf5(H5Pset_driver(access, driver(), &info), "open the file");
  return access;
}

/// How many bytes a file has by its first block, or 0 where that does not tell:
/// behind a block of the user, say. "Superblock" of the HDF5 File Format
/// Specification 3.0: an address behind the last byte, counted from a base that
/// stands 16 bytes before it.
std::uint64_t stated_size(OpenFile& file) {
  std::array<std::byte, 56> bytes{};
  if (file.read_at(0, bytes) < bytes.size() ||
      !starts_with(bytes, kHdf5Signature))
    return 0;
  const std::uint64_t version = little_number(bytes, 8, 1);
  const std::uint64_t address = little_number(bytes, version < 2 ? 13 : 9, 1);
  if (version > 3 || address != 8) return 0;
  const std::size_t base = version == 0   ? 24
                           : version == 1 ? 28
                                          : 12;  // [byte]
  return little_number(bytes, base, 8) == 0 ? little_number(bytes, base + 16, 8)
                                            : 0;
}

// HDF5 requires a name for a file.
constexpr const char* kName = "beamgyro";

}  // namespace

H5Id open_hdf5_file(OpenFile& file) {
  if (const std::uint64_t whole = stated_size(file); whole > file.size())
    throw Hdf5Error(fmt::format(
        "{} of {} bytes are there; expected a whole copy", file.size(), whole));
  return {H5Fopen(kName, H5F_ACC_RDONLY, properties_for(file)), H5Fclose,
          "open the file"};
}

H5Id create_hdf5_file(OpenFile& file) {
  return {H5Fcreate(kName, H5F_ACC_TRUNC, creation_properties(H5P_FILE_CREATE),
                    properties_for(file)),
          H5Fclose, "create the file"};
}

bool take_met_global_heap() { return std::exchange(met_global_heap, false); }

int take_failed_system_call() {
  write_failed = false;
  return std::exchange(failed_call, 0);
}

bool has_failed_write() { return write_failed; }

void check_system_calls() {
  if (failed_call != 0) check_hdf5(-1, "read the file");
}

}  // namespace beamgyro::internal
