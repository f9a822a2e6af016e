// SPDX-License-Identifier: MIT
#include "validation/result/decided_limits.h"

#include <algorithm>

namespace beamgyro::internal {
namespace {

std::optional<Estimate> estimate_of(const MetricResult& result,
                                    const std::string& reference) {
  if (reference == "before") return result.before;
  for (const BaselineEstimate& baseline : result.baselines)
    if (baseline.name == reference) return baseline.estimate;
  return std::nullopt;
}

}  // namespace

bool reads_run(const Metric& metric, const MetricRuns& runs,
               const std::string& name, RunPurpose purpose) {
  const auto named = runs.find(metric.name);
  return named != runs.end() ? std::ranges::count(named->second, name) > 0
                             : std::ranges::count(metric.reads, purpose) > 0;
}

std::vector<DecidedLimit> decided_limits(
    const SpecificationFile& specification,
    const std::vector<MetricResult>& metrics,
    const std::vector<OwnMetricResult>& own_metrics) {
  std::vector<DecidedLimit> decided;
  for (const Limit& limit : specification.limits) {
    const auto result =
        std::ranges::find_if(metrics, [&](const MetricResult& one) {
          return one.metric->name == limit.metric;
        });
    std::optional<Estimate> before, after, reference;
    if (result != metrics.end()) {
      before = result->before;
      after = result->after;
      reference = estimate_of(*result, limit.relative_to);
    }
    const auto own =
        std::ranges::find(own_metrics, limit.metric, &OwnMetricResult::name);
    if (limit.is_own && own != own_metrics.end()) {
      before = own->before;
      after = own->after;
      if (limit.relative_to == "before") reference = before;
    }
    const double risk = specification.false_accept_risk;
    decided.push_back({limit, decide(limit, after, reference, risk)});
    if (limit.relative_to != "before")
      decided.back().decision.met_before =
          decide(limit, before, reference, risk).result == Verdict::kPass;
  }
  return decided;
}

}  // namespace beamgyro::internal
