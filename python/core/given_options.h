// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace beamgyro::python {

/// Sets `member` to the entry `name` of `given`, if there is one.
template <class Member>
void take(const pybind11::dict& given, const char* name, Member& member) {
  if (given.contains(name)) member = given[name].cast<Member>();
}

}  // namespace beamgyro::python
