// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// C99 source of a compensator for firmware: single precision, no allocation,
/// no library but memcpy.
struct ExportedC {
  std::string header;     // NAME.h
  std::string source;     // NAME.c
  std::string self_test;  // NAME_selftest.c, the only one with main()
  std::string plugin;     // NAME_plugin.c, for validation only
  std::vector<std::string> warnings;  // what `force` overrode
};

/// Writes the source text; `name` is a C identifier. Throws
/// std::invalid_argument with the first objection of findings_of(). With
/// `force` the objections become warnings in the text instead.
///
/// The results have the same bits on every machine with IEEE-754 single
/// precision when the compiler does not contract a * b + c: gcc and clang want
/// -ffp-contract=off. Throws as findings_of().
ExportedC export_c(const FittedCompensator& compensator,
                   const std::string& name, bool force = false);

}  // namespace beamgyro::internal
