// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "include/beamgyro/compensator.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {

/// What a Compensator holds.
struct CompensatorState {
  std::string text, name;
  std::string file;  // its path; empty when it is in memory only
  FittedCompensator compensator;

  /// Returns its path, or the name that it was given in memory.
  const std::string& path() const { return file.empty() ? name : file; }
};

/// A program or library of the user.
class OpenedCompensator final : public RateCompensator {
 public:
  explicit OpenedCompensator(CompensatorSource source)
      : source_(std::move(source)) {}

  std::string name() const override { return source_.name; }
  std::vector<std::string> inputs() const override;
  CompensatedRate answer(const Recording& recording) const override;

  const CompensatorSource& source() const { return source_; }

 private:
  CompensatorSource source_;
};

/// Returns a compensator as the validator asks it. `compensator` must outlive
/// it. One of the user's own class is called for each powered stretch, of which
/// it sees the powered samples of its inputs.
CompensatorSource source_of(const RateCompensator& compensator);

CompensatedRate public_answer(Answer answer);

/// Throws std::invalid_argument "name: ..." for a recording that could not be
/// written to a file, such as one whose times do not increase.
void require_sound(const Recording& recording, const std::string& name);

/// Returns compensate() of a recording called `name` in messages. Where the
/// answers have faults, these are added to `faults`, and nothing is returned.
CompensatedRun compensated(const RateCompensator& compensator,
                           Recording recording, const std::string& name,
                           std::vector<std::string>& faults);

}  // namespace beamgyro::internal
