// SPDX-License-Identifier: MIT
#include "compensation/export/export_findings.h"

#include <fmt/format.h>

#include <optional>

#include "compensation/export/firmware_difference.h"
#include "compensation/scoring/scale_factor.h"
#include "compensation/training/rate_kept.h"

namespace beamgyro::internal {

ExportFindings findings_of(const FittedCompensator& compensator) {
  ExportFindings found;
  const FirmwareDifference differences = firmware_differences(compensator);
  found.difference = differences.rate;
  found.sigma_difference = differences.sigma;
  const std::optional<double> kept = rate_kept(compensator);
  if (kept && !(*kept >= kCancelledBelow))
    found.objections.push_back(fmt::format(
        "it cancels the rate: of a small rate it lets {:.4f} through, and "
        "{:g} is the least",
        *kept, kCancelledBelow));
  if (!(found.difference <= kLargestDifference))
    found.objections.push_back(fmt::format(
        "its answers in single precision differ by up to {:.2g} deg/s from "
        "those of compensate, and {:g} deg/s is the most; large terms that "
        "cancel lose digits, and weight_decay keeps those of a network small",
        found.difference, kLargestDifference));
  if (!(found.sigma_difference <= kLargestDifference))
    found.objections.push_back(fmt::format(
        "its sigma in single precision differs by up to {:.2g} deg/s from that "
        "of compensate, and {:g} deg/s is the most",
        found.sigma_difference, kLargestDifference));
  return found;
}

}  // namespace beamgyro::internal
