// SPDX-License-Identifier: MIT
#include "sensitivity/study/factor.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "sim/campaign/distribution.h"

namespace beamgyro::internal {
namespace {

// The lowest draw that each draw is joined with, itself or an earlier one.
std::vector<std::size_t> first_joined(const DrawPlan& plan,
                                      const std::vector<std::size_t>& draw_of) {
  std::vector<std::size_t> first(plan.draws.size());
  std::iota(first.begin(), first.end(), 0);
  for (const CorrelatedGroup& group : plan.groups) {
    for (const std::size_t member : group.members) {
      const std::size_t one = first[draw_of[group.members.front()]];
      const std::size_t other = first[draw_of[member]];
      std::replace(first.begin(), first.end(), std::max(one, other),
                   std::min(one, other));
    }
  }
  return first;
}

}  // namespace

std::vector<Factor> factors_of(const DrawPlan& plan) {
  std::vector<std::size_t> draw_of;  // of each number
  for (std::size_t k = 0; k < plan.draws.size(); ++k)
    draw_of.insert(draw_of.end(), plan.draws[k].numbers(), k);
  const std::vector<std::size_t> first = first_joined(plan, draw_of);
  std::vector<Factor> factors;
  for (std::size_t k = 0; k < plan.draws.size(); ++k) {
    if (first[k] != k) continue;
    Factor factor;
    for (std::size_t other = k; other < plan.draws.size(); ++other) {
      if (first[other] != k) continue;
      factor.key +=
          (factor.key.empty() ? "" : " + ") + key_of(plan.draws[other]);
      for (std::size_t n = 0; n < draw_of.size(); ++n)
        if (draw_of[n] == other) factor.numbers.push_back(n);
    }
    factors.push_back(factor);
  }
  return factors;
}

void require_comparable(const std::vector<Factor>& factors,
                        const std::string& campaign) {
  if (factors.size() >= 2) return;
  throw std::invalid_argument(fmt::format(
      "{}: [tolerances]: {}, so there is nothing to compare; expected two keys "
      "or more that are drawn independently",
      campaign,
      factors.empty() ? "no device differs from another"
                      : fmt::format("only {} differs between devices",
                                    factors.front().key)));
}

DrawPlan with_halved(DrawPlan plan, std::size_t index) {
  Distribution& distribution = plan.draws[index].distribution;
  distribution = halved(distribution);
  return plan;
}

}  // namespace beamgyro::internal
