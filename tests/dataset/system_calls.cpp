// SPDX-License-Identifier: MIT
#include "tests/dataset/system_calls.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <mutex>
#include <optional>

namespace beamgyro::internal {
namespace {

struct Watch {
  std::vector<std::string> made;
  std::string failing;
  int error = 0, times = 0;
};

std::mutex mutex;
std::optional<Watch> watch;

/// Whether the call is to fail, with errno set.
bool fails(const char* name) {
  const std::lock_guard lock(mutex);
  if (!watch) return false;
  watch->made.emplace_back(name);
  if (watch->failing != name || watch->times == 0) return false;
  --watch->times;
  errno = watch->error;
  return true;
}

template <class... Arguments>
int passed_on(const char* name, long number, Arguments... arguments) {
  if (fails(name)) return -1;
  return static_cast<int>(syscall(number, arguments...));
}

}  // namespace

SystemCalls::SystemCalls() {
  const std::lock_guard lock(mutex);
  watch.emplace();
}

SystemCalls::~SystemCalls() {
  const std::lock_guard lock(mutex);
  watch.reset();
}

void SystemCalls::fail_next(const std::string& name, int error, int times) {
  const std::lock_guard lock(mutex);
  watch->failing = name;
  watch->error = error;
  watch->times = times;
}

std::vector<std::string> SystemCalls::made() const {
  const std::lock_guard lock(mutex);
  return watch->made;
}

}  // namespace beamgyro::internal

// In place of those of the C library.
extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = va_arg(arguments, int);  // nonsense without O_CREAT
  va_end(arguments);
  return beamgyro::internal::passed_on("open", SYS_openat, AT_FDCWD, path,
                                       flags, mode);
}

int openat(int directory, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = va_arg(arguments, int);
  va_end(arguments);
  return beamgyro::internal::passed_on("openat", SYS_openat, directory, path,
                                       flags, mode);
}

int close(int file) {
  return beamgyro::internal::passed_on("close", SYS_close, file);
}

int fsync(int file) {
  return beamgyro::internal::passed_on("fsync", SYS_fsync, file);
}

int flock(int file, int operation) {
  return beamgyro::internal::passed_on("flock", SYS_flock, file, operation);
}

int renameat(int from, const char* old_name, int to,
             const char* new_name) noexcept {
  return beamgyro::internal::passed_on("renameat", SYS_renameat, from, old_name,
                                       to, new_name);
}

}  // extern "C"
