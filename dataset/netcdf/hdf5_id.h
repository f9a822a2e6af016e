// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace beamgyro::internal {

/// Thrown when a call of the HDF5 library fails, or when a file cannot be what
/// it claims to be.
struct Hdf5Error : std::runtime_error {
  explicit Hdf5Error(const std::string& message, int error = 0)
      : std::runtime_error(message), error_number(error) {}
  int error_number;  // errno of the system call that failed; 0: none did
};

/// Throws Hdf5Error "cannot <action>: <cause>" when `status` is negative or a
/// write has failed below the library, which does not learn of it. The cause is
/// the system call that failed, or else the innermost entry of the library's
/// error stack.
void check_hdf5(herr_t status, const std::string& action);

/// Returns a yes or no that the library answered. A negative value means that
/// it could not answer, and throws as check_hdf5().
bool is_true(htri_t answer, const std::string& question);

/// Returns errno of the first system call that failed below the library since
/// the last call of this function, or 0; see hdf5_driver.h.
int take_failed_system_call();

/// Returns whether a write failed since then.
bool has_failed_write();

/// Gives this thread sole use of HDF5 until the end of the scope, because the
/// high-level part of the library has no lock of its own. HDF5 then does not
/// - print its error stack;
/// - run the code of plug-ins that a file names.
/// At the end of the scope it is for other users of HDF5 in this process as it
/// was before. Not re-entrant: a second object in the same thread deadlocks.
class QuietHdf5 {
 public:
  QuietHdf5() {
    take_failed_system_call();  // of whoever closed a file that failed
    check_hdf5(H5PLget_loading_state(&plugins_), "start HDF5");
    check_hdf5(H5PLset_loading_state(0), "start HDF5");
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() {
    H5Eset_auto2(H5E_DEFAULT, print_, data_);
    H5PLset_loading_state(plugins_);
  }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  static std::mutex& mutex();

  std::lock_guard<std::mutex> alone_{mutex()};
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
  unsigned plugins_ = 0;
};

/// Owner of an HDF5 id. `release` is H5Fclose, H5Dclose, ...
class H5Id {
 public:
  H5Id(hid_t id, herr_t (*release)(hid_t), const std::string& action)
      : id_(id), release_(release) {
    if (id_ >= 0 && has_failed_write()) release_(std::exchange(id_, -1));
    check_hdf5(id < 0 ? -1 : 0, action);
  }
  ~H5Id() {
    if (id_ >= 0) release_(id_);
  }
  H5Id(H5Id&& other) noexcept
      : id_(std::exchange(other.id_, -1)), release_(other.release_) {}
  H5Id& operator=(H5Id&&) = delete;
  operator hid_t() const { return id_; }
  /// Closes an id that was written to, and checks the result.
  void close(const std::string& action) {
    check_hdf5(release_(std::exchange(id_, -1)), action);
  }

 private:
  hid_t id_;
  herr_t (*release_)(hid_t);
};

H5Id property_list(hid_t kind);

/// Returns the properties with which files are opened: the format that MATLAB
/// releases of 2015 still read.
H5Id access_properties();

}  // namespace beamgyro::internal
