// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "include/beamgyro/compensator.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {

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

}  // namespace beamgyro::internal
