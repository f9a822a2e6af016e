// SPDX-License-Identifier: MIT
#include "validation/evidence/evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
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

std::vector<RunPurpose> quiet_purposes() {
  using enum RunPurpose;
  return {kSoak, kRamp, kWarmUp, kPowerCycle, kRest, kConstantRate};
}

std::optional<TemperatureRange> temperatures_of(
    const std::vector<const Recording*>& runs) {
  TemperatureRange range = {HUGE_VAL, -HUGE_VAL};
  for (const Recording* run : runs) {
    const Column* temperature = find_column(*run, "temperature");
    if (temperature == nullptr) return std::nullopt;
    for (std::size_t k = 0; k < run->time.size(); ++k)
      if ((run->status[k] & kUnpowered) == 0) {
        range.lowest = std::min(range.lowest, temperature->values[k]);
        range.highest = std::max(range.highest, temperature->values[k]);
      }
  }
  return range.lowest <= range.highest ? std::optional(range) : std::nullopt;
}

}  // namespace beamgyro::internal
