// SPDX-License-Identifier: MIT
#include <vector>

#include "validation/metrics/evaluations.h"
#include "validation/metrics/sigma_evidence.h"
#include "validation/metrics/sigma_report.h"

namespace beamgyro::internal::evaluation {
namespace {

std::optional<Estimate> percent(std::optional<Estimate> share) {
  if (!share) return share;
  share->value *= 100.0;
  share->interval->low *= 100.0;
  share->interval->high *= 100.0;
  return share;
}

std::optional<Estimate> distance_of(const std::vector<ErrorGroup>& groups) {
  const std::optional<PitReport> report = pit_report(groups);
  if (!report) return std::nullopt;
  return Estimate{report->distance};
}

}  // namespace

std::optional<Estimate> soak_coverage_50(const Evidence& evidence) {
  return percent(coverage(soak_errors(evidence), 0.5));
}

std::optional<Estimate> soak_coverage_90(const Evidence& evidence) {
  return percent(coverage(soak_errors(evidence), 0.9));
}

std::optional<Estimate> soak_coverage_95(const Evidence& evidence) {
  return percent(coverage(soak_errors(evidence), 0.95));
}

std::optional<Estimate> ramp_coverage_50(const Evidence& evidence) {
  return percent(coverage(ramp_errors(evidence), 0.5));
}

std::optional<Estimate> ramp_coverage_90(const Evidence& evidence) {
  return percent(coverage(ramp_errors(evidence), 0.9));
}

std::optional<Estimate> ramp_coverage_95(const Evidence& evidence) {
  return percent(coverage(ramp_errors(evidence), 0.95));
}

std::optional<Estimate> soak_pit_distance(const Evidence& evidence) {
  return distance_of(soak_errors(evidence));
}

std::optional<Estimate> ramp_pit_distance(const Evidence& evidence) {
  return distance_of(ramp_errors(evidence));
}

std::optional<Estimate> bias_filter_nis(const Evidence& evidence) {
  return mean_normalised(filter_runs(evidence));
}

}  // namespace beamgyro::internal::evaluation
