// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "include/beamgyro/compensator.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// A program or library of the user.
class OpenedCompensator final : public RateCompensator {
 public:
  /// Throws as open_tested_compensator().
  OpenedCompensator(std::string argument, const ProcessLimits& limits);

  std::string name() const override { return tested_name(argument_); }
  std::vector<std::string> inputs() const override;
  CompensatedRate answer(const Recording& recording) const override;

  const std::string& argument() const { return argument_; }
  const ProcessLimits& limits() const { return limits_; }
  const TestedCompensator& opened() const { return *opened_; }

 private:
  std::string argument_;
  ProcessLimits limits_;
  std::shared_ptr<const TestedCompensator> opened_;
};

/// Returns a compensator as the validator calls it. `compensator` must outlive
/// it. One of the user's own class is called for each powered stretch, of which
/// it sees the powered samples of its inputs.
std::unique_ptr<TestedCompensator> tested(const RateCompensator& compensator);

CompensatedRate public_answer(Answer answer);

}  // namespace beamgyro::internal
