// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/result/validation_result.h"

namespace beamgyro::internal {

/// Returns a result as servers of continuous integration read it: JUnit XML
/// (docs/reference/validation_result.md), a test case for each limit, each
/// required comparison, each check, and the verdict. What is undecided fails; a
/// check that was not tested is skipped. The same result gives the same bytes.
std::string junit_report(const ValidationResult& result);

/// Returns a line for each of the same cases: result, name, value, low and high
/// end of its interval, unit, limit and a sentence, with tabs between.
std::string line_report(const ValidationResult& result);

}  // namespace beamgyro::internal
