// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "validation/checks/declared_response.h"
#include "validation/specification/decision.h"

namespace beamgyro::internal {

/// What a user asks of a compensated gyro (docs/reference/specification_file).
struct SpecificationFile {
  std::string name, description;
  double false_accept_risk = kFalseAcceptRisk;  // [-]
  std::vector<Limit> limits;                    // in file order
  // "before", "constant": what has to leave more of the drift on the same runs.
  std::vector<std::string> better_than = {};
  // Whether a check that no run tests leaves the verdict as it is.
  bool may_leave_untested = false;
  DeclaredResponse declared = {};  // how the compensator answers on purpose
  std::string text;                // byte for byte as read
};

/// Reads a file of limits. Throws std::invalid_argument with file, line and
/// column for
/// - text that is not TOML, and keys that are not known;
/// - a metric that is not in metrics(), with the nearest name, but those of
///   the user's own, below `limits.own` and `limits_relative_to.before.own`;
/// - a limit without `max` and `min`, one with `min` above `max`, and one
///   without a source;
/// - no limit and nothing that it has to be better than;
/// - a risk outside (0, 0.5];
/// - a declared figure that is out of range.
SpecificationFile read_specification_file(const std::filesystem::path& file);

/// The same for a text in memory, called `name` in messages.
SpecificationFile parse_specification_file(std::string_view text,
                                           const std::string& name);

/// Returns specs/default.toml, which stands for a specification that is not
/// given.
const SpecificationFile& default_specification();

}  // namespace beamgyro::internal
