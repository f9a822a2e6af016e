// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace beamgyro {

inline constexpr const char* kRecordingFiletype = "beamgyro-recording";

/// A call of the HDF5 library that failed, or a file it cannot be right about.
struct Hdf5Error : std::runtime_error {
  explicit Hdf5Error(const std::string& message, int error = 0)
      : std::runtime_error(message), error_number(error) {}
  int error_number;  // errno of the system call that failed; 0: none did
};

/// Throws Hdf5Error "cannot <action>: <cause>" when `status` is negative; the
/// cause is the system call that failed, or else the innermost entry of the
/// library's error stack.
void check_hdf5(herr_t status, const std::string& action);

/// The answer of a question to the library, which is negative when it could not
/// be told: that is no "no", and throws as check_hdf5().
bool is_true(htri_t answer, const std::string& question);

/// errno of the first call of the system that failed below the library since
/// this was asked, 0 without one; see hdf5_driver.h.
int take_failed_system_call();

/// HDF5 for this thread alone until the end of the scope; its high-level part
/// has no lock of its own. Keeps it from printing its error stack, from running
/// the code of plug-ins that a file names, and from tidying up at the end of
/// the process, where 1.10 crashes after a full disk. Two in one thread wait
/// for ever.
class QuietHdf5 {
 public:
  QuietHdf5() {
    static const herr_t no_exit_handler = H5dont_atexit();
    check_hdf5(no_exit_handler, "start HDF5");
    static const herr_t no_plugins = H5PLset_loading_state(0);
    check_hdf5(no_plugins, "start HDF5");
    take_failed_system_call();
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  static std::mutex& mutex();

  std::lock_guard<std::mutex> alone_{mutex()};
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// One owner for every HDF5 id; `release` is H5Fclose, H5Dclose, ...
class H5Id {
 public:
  H5Id(hid_t id, herr_t (*release)(hid_t), const std::string& action)
      : id_(id), release_(release) {
    check_hdf5(id < 0 ? -1 : 0, action);
  }
  ~H5Id() {
    if (id_ >= 0) release_(id_);
  }
  H5Id(H5Id&& other) noexcept
      : id_(std::exchange(other.id_, -1)), release_(other.release_) {}
  H5Id& operator=(H5Id&&) = delete;
  operator hid_t() const { return id_; }
  /// The checked end of an id that was written to.
  void close(const std::string& action) {
    check_hdf5(release_(std::exchange(id_, -1)), action);
  }

 private:
  hid_t id_;
  herr_t (*release_)(hid_t);
};

H5Id property_list(hid_t kind);

/// How files are opened: in the format MATLAB releases of 2015 still read.
H5Id access_properties();

}  // namespace beamgyro
