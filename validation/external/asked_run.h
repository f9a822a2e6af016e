// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace beamgyro::internal {

/// Names the run that a compensator is asked about on this thread, for the
/// messages of a compensator that is called for parts of it. The innermost name
/// counts.
class AskedRun {
 public:
  /// `name` must outlive the object.
  explicit AskedRun(const std::string& name);
  ~AskedRun();
  AskedRun(const AskedRun&) = delete;
  AskedRun& operator=(const AskedRun&) = delete;

  /// Returns the name, or an empty text where there is none.
  static std::string name();

 private:
  const std::string* outer_;
};

}  // namespace beamgyro::internal
