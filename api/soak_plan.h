// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compensation/inputs/features.h"
#include "include/beamgyro/plan.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument unless there is one goal.
void check_goal(const PlanOptions& options);

/// A plan that is being made: what it needs has been read and checked.
class PlanStudy {
 public:
  /// Throws as plan(), but for the candidates, which are not looked at.
  PlanStudy(const Compensator& population, const Device& device,
            const PlanOptions& options);
  ~PlanStudy();
  PlanStudy(const PlanStudy&) = delete;
  PlanStudy& operator=(const PlanStudy&) = delete;

  /// Temperatures of the chamber at which a soak may be [degC].
  const TemperatureRange& chamber() const;

  /// Plans, and judges candidates, which checked_soaks() has seen.
  SoakPlanResult result(
      const std::vector<std::vector<double>>& candidates) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns soaks in their order. Throws std::invalid_argument "where: ..." for
/// none, for one beyond the chamber, and for two that are closer together than
/// kPointWidth.
std::vector<double> checked_soaks(std::vector<double> soaks,
                                  const std::string& where,
                                  const TemperatureRange& chamber);

}  // namespace beamgyro::internal
