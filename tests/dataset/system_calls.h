// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace beamgyro::internal {

/// Calls of the system by this test program, which pass through here. While one
/// of these lives they are counted, and may be told to fail.
class SystemCalls {
 public:
  SystemCalls();
  ~SystemCalls();
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;

  /// The next `times` calls of `name` do nothing but fail.
  void fail_next(const std::string& name, int error, int times);

  /// Names of calls so far: open, openat, close, fsync, flock, renameat.
  std::vector<std::string> made() const;
};

}  // namespace beamgyro::internal
