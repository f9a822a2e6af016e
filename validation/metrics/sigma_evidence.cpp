// SPDX-License-Identifier: MIT
#include "validation/metrics/sigma_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/uncertainty/bias_sigma.h"
#include "validation/metrics/segments.h"
#include "validation/metrics/soaks.h"

namespace beamgyro::internal {
namespace {

constexpr double kMovingSlope = 0.05;  // [K/min]

// Means of the residual over segments of a run, divided by their sigma.
std::vector<double> normalised_errors(const EvidenceRun& run,
                                      std::span<const Segment> segments) {
  std::vector<double> squares = run.sigma;
  for (double& sigma : squares) sigma *= sigma;
  const std::vector<double> variances = means_over(segments, squares);
  std::vector<double> z = means_over(segments, residual_of(run));
  for (std::size_t i = 0; i < z.size(); ++i) z[i] /= std::sqrt(variances[i]);
  return z;
}

// Adds the errors of the segments in `taken`: those within kBiasCorrelation of
// the first one of a group, in the same power cycle, join it.
void add_groups(std::span<const Segment> segments, std::span<const double> z,
                const std::vector<bool>& taken,
                std::vector<ErrorGroup>& groups) {
  const Segment* first = nullptr;  // of the group
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (!std::isfinite(z[k]) || !taken[k]) continue;
    if (first == nullptr || segments[k].power_on != first->power_on ||
        std::abs(segments[k].temperature - first->temperature) >=
            kBiasCorrelation) {
      groups.push_back({groups.size(), {}});
      first = &segments[k];
    }
    groups.back().z.push_back(z[k]);
  }
}

void add_soaks(const EvidenceRun& run, std::vector<ErrorGroup>& groups) {
  const std::vector<Segment> soaks =
      segments_of(*run.recording, ranges_of(soaks_of(*run.recording)));
  add_groups(soaks, normalised_errors(run, soaks),
             std::vector<bool>(soaks.size(), true), groups);
}

// Whether the temperature moves from a block to the next one or from the one
// before.
bool is_moving(std::span<const Segment> blocks, std::size_t k) {
  const std::size_t first = k == 0 ? 0 : k - 1;
  const std::size_t last = std::min(k + 1, blocks.size() - 1);
  const double minutes = (blocks[last].time - blocks[first].time) / 60.0;
  const double move =
      std::abs(blocks[last].temperature - blocks[first].temperature);
  return minutes > 0.0 && move >= kMovingSlope * minutes;
}

void add_ramps(const EvidenceRun& run, std::vector<ErrorGroup>& groups) {
  const std::vector<Segment> blocks =
      segments_of(*run.recording, score_blocks(*run.recording));
  std::vector<bool> moving(blocks.size());
  for (std::size_t k = 0; k < blocks.size(); ++k)
    moving[k] = is_moving(blocks, k);
  add_groups(blocks, normalised_errors(run, blocks), moving, groups);
}

std::vector<ErrorGroup> errors_of(const Evidence& evidence,
                                  void (*add)(const EvidenceRun&,
                                              std::vector<ErrorGroup>&)) {
  std::vector<ErrorGroup> groups;
  for (const EvidenceRun* run :
       runs_for(evidence, {RunPurpose::kSoak, RunPurpose::kRamp}))
    if (!run->sigma.empty()) add(*run, groups);
  return groups;
}

}  // namespace

void SigmaEvidence::add_device(const SigmaEvidence& device,
                               std::size_t cluster) {
  const auto add = [cluster](const auto& from, auto& to) {
    for (const auto& group : from) {
      to.push_back(group);
      to.back().cluster = cluster;
    }
  };
  add(device.soaks, soaks);
  add(device.ramps, ramps);
  add(device.filter, filter);
}

bool states_sigma(const Evidence& evidence) {
  return std::ranges::any_of(
      evidence.runs, [](const EvidenceRun& run) { return !run.sigma.empty(); });
}

std::vector<ErrorGroup> soak_errors(const Evidence& evidence) {
  return errors_of(evidence, add_soaks);
}

std::vector<ErrorGroup> ramp_errors(const Evidence& evidence) {
  return errors_of(evidence, add_ramps);
}

std::vector<FilterRun> filter_runs(const Evidence& evidence) {
  using enum RunPurpose;
  std::vector<FilterRun> found;
  for (const EvidenceRun* run :
       runs_for(evidence, {kSoak, kRamp, kWarmUp, kPowerCycle})) {
    if (run->sigma.empty()) continue;
    FilterRun filter{found.size(), {}};
    for (const Innovation& innovation : filter_innovations(*run))
      filter.normalised.push_back(innovation.normalised());
    if (!filter.normalised.empty()) found.push_back(std::move(filter));
  }
  return found;
}

SigmaEvidence sigma_evidence(const Evidence& evidence) {
  return {soak_errors(evidence), ramp_errors(evidence), filter_runs(evidence)};
}

}  // namespace beamgyro::internal
