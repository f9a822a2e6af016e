// SPDX-License-Identifier: MIT
#include "dataset/hdf5_id.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

// What HDF5 keeps to the end of the process, see QuietHdf5, is no leak.
extern "C" const char* __lsan_default_suppressions();   // NOLINT
extern "C" const char* __lsan_default_suppressions() {  // NOLINT
  return "leak:libhdf5\n";
}

extern "C" const char* __lsan_default_options();   // NOLINT
extern "C" const char* __lsan_default_options() {  // NOLINT
  return "print_suppressions=0";
}

namespace beamgyro {

void check_hdf5(herr_t status, const std::string& action) {
  if (status >= 0) return;
  std::string cause;
  const auto take_first = [](unsigned n, const H5E_error2_t* entry,
                             void* text) -> herr_t {
    if (n == 0 && entry->desc != nullptr)
      *static_cast<std::string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &cause);
  // Of a failed call of the system it tells time, names and addresses, too.
  constexpr std::string_view kNumber = "errno = ";
  constexpr std::string_view kSystem = "error message = '";
  int error = 0;
  if (const auto at = cause.find(kNumber); at != std::string::npos)
    std::from_chars(cause.data() + at + kNumber.size(),
                    cause.data() + cause.size(), error);
  if (const auto at = cause.find(kSystem); at != std::string::npos) {
    cause.erase(0, at + kSystem.size());
    cause.erase(std::min(cause.find('\''), cause.size()));
  }
  throw Hdf5Error(cause.empty() ? "cannot " + action
                                : fmt::format("cannot {}: {}", action, cause),
                  error);
}

bool is_true(htri_t answer, const std::string& question) {
  check_hdf5(answer < 0 ? -1 : 0, question);
  return answer > 0;
}

std::mutex& QuietHdf5::mutex() {
  static std::mutex one;
  return one;
}

H5Id property_list(hid_t kind) {
  return {H5Pcreate(kind), H5Pclose, "create a property list"};
}

H5Id access_properties() {
  H5Id access = property_list(H5P_FILE_ACCESS);
  check_hdf5(H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V110),
             "choose the file format");
  check_hdf5(H5Pset_file_locking(access, true, true), "choose file locking");
  return access;
}

}  // namespace beamgyro
