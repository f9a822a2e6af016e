// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

namespace beamgyro::python {

/// Marks a compensator of Python as asked for an answer by this thread, and by
/// the threads of long_call() that work for it meanwhile.
class Asked {
 public:
  using Compensators = std::vector<const void*>;  // outer ones first

  explicit Asked(const void* compensator) { here().push_back(compensator); }
  ~Asked() { here().pop_back(); }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  /// Those that wait for this thread.
  static const Compensators& all() { return here(); }
  /// Begins a thread that works for those compensators.
  static void inherit(Compensators all) { here() = std::move(all); }

 private:
  static Compensators& here() {
    static thread_local Compensators all;
    return all;
  }
};

}  // namespace beamgyro::python
