// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_id.h"

#include <fmt/format.h>
#include <pthread.h>

#include <system_error>

#include "dataset/netcdf/hdf5_exit.h"

namespace beamgyro::internal {

void check_hdf5(herr_t status, const std::string& action) {
  if (status >= 0 && !has_failed_write()) return;
  const int error = take_failed_system_call();
  std::string cause;
  const auto take_first = [](unsigned n, const H5E_error2_t* entry,
                             void* text) -> herr_t {
    if (n == 0 && entry->desc != nullptr)
      *static_cast<std::string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &cause);
  if (error != 0) cause = std::generic_category().message(error);
  throw Hdf5Error(cause.empty() ? "cannot " + action
                                : fmt::format("cannot {}: {}", action, cause),
                  error);
}

bool is_true(htri_t answer, const std::string& question) {
  check_hdf5(answer < 0 ? -1 : 0, question);
  return answer > 0;
}

std::mutex& QuietHdf5::mutex() {
  // Never destroyed: a fork may come after the end of main().
  static auto& one = *new std::mutex;
  // A child of fork() has one thread: it would wait for ever for another one
  // that used HDF5, and would meet it half changed. So a fork waits.
  static const int registered = pthread_atfork(
      [] { one.lock(); }, [] { one.unlock(); }, [] { one.unlock(); });
  static_cast<void>(registered);
  return one;
}

H5Id property_list(hid_t kind) {
  return {H5Pcreate(kind), H5Pclose, "create a property list"};
}

H5Id access_properties() {
  H5Id access = property_list(H5P_FILE_ACCESS);
  check_hdf5(H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V110),
             "choose the file format");
  return access;
}

void keep_hdf5_open_at_exit() { check_hdf5(H5dont_atexit(), "start HDF5"); }

}  // namespace beamgyro::internal
