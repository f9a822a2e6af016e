// SPDX-License-Identifier: MIT
#include "validation/evidence/evidence.h"

#include <algorithm>
#include <array>
#include <utility>

namespace beamgyro::internal {
namespace {

constexpr std::array<std::pair<RunPurpose, std::string_view>, 12> kPurposes = {{
    {RunPurpose::kSoak, "soak"},
    {RunPurpose::kRamp, "ramp"},
    {RunPurpose::kWarmUp, "warm_up"},
    {RunPurpose::kPowerCycle, "power_cycle"},
    {RunPurpose::kRateTable, "rate_table"},
    {RunPurpose::kConstantRate, "constant_rate"},
    {RunPurpose::kSineRate, "sine_rate"},
    {RunPurpose::kRateStep, "rate_step"},
    {RunPurpose::kRest, "rest"},
    {RunPurpose::kTumble, "tumble"},
    {RunPurpose::kRandomRate, "random_rate"},
    {RunPurpose::kVibration, "vibration"},
}};

}  // namespace

std::string_view purpose_name(RunPurpose purpose) {
  return std::ranges::find(kPurposes, purpose,
                           &std::pair<RunPurpose, std::string_view>::first)
      ->second;
}

std::optional<RunPurpose> purpose_of(std::string_view name) {
  const auto* found = std::ranges::find(
      kPurposes, name, &std::pair<RunPurpose, std::string_view>::second);
  if (found == kPurposes.end()) return std::nullopt;
  return found->first;
}

std::vector<const EvidenceRun*> runs_for(
    const Evidence& evidence, const std::vector<RunPurpose>& purposes) {
  std::vector<const EvidenceRun*> found;
  for (const EvidenceRun& run : evidence.runs)
    if (std::ranges::find(purposes, run.purpose) != purposes.end())
      found.push_back(&run);
  return found;
}

}  // namespace beamgyro::internal
