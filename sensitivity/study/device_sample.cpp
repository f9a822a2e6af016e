// SPDX-License-Identifier: MIT
#include "sensitivity/study/device_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "parallel/work_queue.h"
#include "random/random_stream.h"
#include "sim/campaign/distribution.h"
#include "sim/campaign/scrambled_sobol.h"
#include "sim/numerics/simulation_failure.h"

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

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct DrawnMerits {
  std::vector<double> values;  // none when it does not work
  std::string failure;
};

DrawnMerits drawn_merits(const CampaignPlan& campaign, const DrawPlan& plan,
                         std::vector<double> uniform,
                         const DeviceSampleOptions& options,
                         DeviceSampleCounts& counts) {
  const VirtualDevice drawn = campaign.device_at(plan, std::move(uniform));
  DrawnMerits found{{}, drawn.failure};
  CurveLimits limits;
  if (drawn.device) {
    try {
      found.values =
          device_merits(*drawn.device, options.merits, options.merit, &limits);
    } catch (const SimulationFailure& error) {
      found.failure = error.what();
    }
  }
  counts.limited += limits.is_limited;
  counts.saturated += limits.is_saturated;
  ++counts.devices;
  if (counts.on_device) counts.on_device();
  if (!found.failure.empty()) ++counts.failures;
  return found;
}

class RowSampler {
 public:
  RowSampler(const CampaignPlan& campaign, const DeviceSampleOptions& options,
             DeviceSampleCounts& counts, DeviceSample& sample)
      : campaign_(campaign),
        options_(options),
        counts_(counts),
        sample_(sample),
        plan_(campaign.device_plan),
        sobol_(2 * plan_.parameters.size(), options.seed),
        failures_(options.rows) {
    for (std::size_t k = 0; k < plan_.draws.size(); ++k) {
      const Distribution& d = plan_.draws[k].distribution;
      if (d.kind != Distribution::Kind::kDiscrete)
        halved_.emplace_back(k, with_narrowed(plan_, k, 0.5));
    }
    make_room();
  }

  void sample_row(std::size_t row) {
    const std::size_t numbers = plan_.parameters.size();
    std::vector<double> a(numbers), b(numbers), independent(numbers);
    for (std::size_t n = 0; n < numbers; ++n) {
      const auto index = static_cast<std::uint32_t>(row);
      a[n] = sobol_.at(index, n);
      b[n] = sobol_.at(index, numbers + n);
      RandomStream stream(options_.seed, index, static_cast<std::uint32_t>(n),
                          kRankSampleStream);
      independent[n] = stream.uniform();
    }
    for (std::size_t i = 0; i < sample_.factors.size(); ++i)
      keep_numbers(row, i, independent);
    sample_design(row, a, b);
    compute(row, plan_, std::move(independent),
            [&](MeritSample& merit) { return &merit.independent[row]; });
    if (!options_.halves_tolerances) return;
    for (const auto& [key, plan] : halved_) {
      const std::size_t at = key;
      compute(row, plan, a,
              [row, at](MeritSample& merit) { return &merit.halved[at][row]; });
    }
  }

  const std::vector<std::string>& failures() const { return failures_; }

 private:
  void make_room() {
    const std::size_t rows = options_.rows;
    for (MeritSample& merit : sample_.merits) {
      merit.design = {
          std::vector<double>(rows, kNone),
          std::vector<double>(rows, kNone),
          {sample_.factors.size(), std::vector<double>(rows, kNone)}};
      merit.independent.assign(rows, kNone);
      merit.halved.resize(plan_.draws.size());
      if (!options_.halves_tolerances) continue;
      for (const auto& [key, plan] : halved_)
        merit.halved[key].assign(rows, kNone);
    }
    for (const Factor& factor : sample_.factors)
      sample_.numbers.emplace_back(
          static_cast<Eigen::Index>(rows),
          static_cast<Eigen::Index>(factor.numbers.size()));
  }

  void keep_numbers(std::size_t row, std::size_t factor,
                    const std::vector<double>& uniform) {
    Eigen::Index column = 0;
    for (const std::size_t n : sample_.factors[factor].numbers)
      sample_.numbers[factor](static_cast<Eigen::Index>(row), column++) =
          uniform[n];
  }

  void sample_design(std::size_t row, const std::vector<double>& a,
                     const std::vector<double>& b) {
    compute(row, plan_, a,
            [&](MeritSample& merit) { return &merit.design.a[row]; });
    compute(row, plan_, b,
            [&](MeritSample& merit) { return &merit.design.b[row]; });
    for (std::size_t i = 0; i < sample_.factors.size(); ++i) {
      std::vector<double> changed = a;
      for (const std::size_t n : sample_.factors[i].numbers) changed[n] = b[n];
      compute(row, plan_, std::move(changed),
              [&](MeritSample& merit) { return &merit.design.ab[i][row]; });
    }
  }

  template <class Place>
  void compute(std::size_t row, const DrawPlan& plan,
               std::vector<double> uniform, const Place& place) {
    auto [values, failure] =
        drawn_merits(campaign_, plan, std::move(uniform), options_, counts_);
    for (std::size_t m = 0; m < values.size(); ++m)
      *place(sample_.merits[m]) = values[m];
    if (!failure.empty() && failures_[row].empty())
      failures_[row] = std::move(failure);
  }

  const CampaignPlan& campaign_;
  const DeviceSampleOptions& options_;
  DeviceSampleCounts& counts_;
  DeviceSample& sample_;
  const DrawPlan& plan_;
  ScrambledSobol sobol_;
  std::vector<std::pair<std::size_t, DrawPlan>> halved_;
  std::vector<std::string> failures_;  // the first of each row
};

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

DrawPlan with_narrowed(DrawPlan plan, std::size_t index, double share) {
  Distribution& distribution = plan.draws[index].distribution;
  distribution = narrowed(distribution, share);
  return plan;
}

std::uint64_t devices_of_sample(const CampaignPlan& campaign,
                                const DeviceSampleOptions& options) {
  const DrawPlan& plan = campaign.device_plan;
  std::uint64_t each = 3 + factors_of(plan).size();
  if (options.halves_tolerances) {
    for (const Draw& draw : plan.draws)
      if (draw.distribution.kind != Distribution::Kind::kDiscrete) ++each;
  }
  return each * options.rows;
}

DeviceSample sample_devices(const CampaignPlan& campaign,
                            const DeviceSampleOptions& options,
                            DeviceSampleCounts& counts) {
  DeviceSample sample;
  counts.all_devices = devices_of_sample(campaign, options);
  sample.factors = factors_of(campaign.device_plan);
  require_comparable(sample.factors, campaign.name);
  device_merits(campaign.base_device, options.merits, options.merit);
  for (const Draw& draw : campaign.device_plan.draws)
    sample.keys.push_back(key_of(draw));
  sample.merits.resize(options.merits.size());
  RowSampler sampler(campaign, options, counts, sample);
  for_each_task(options.rows, thread_count(options.jobs),
                [&](std::size_t row, std::size_t) { sampler.sample_row(row); });
  sample.devices = counts.devices;
  sample.failures = counts.failures;
  for (const std::string& failure : sampler.failures()) {
    if (failure.empty()) continue;
    sample.first_failure = failure;
    break;
  }
  return sample;
}

std::vector<std::vector<double>> narrowed_merits(
    const CampaignPlan& campaign, const DeviceSampleOptions& options,
    const std::vector<Narrowing>& narrowings, DeviceSampleCounts& counts) {
  std::vector<DrawPlan> plans;
  for (const auto& [draws, share] : narrowings) {
    plans.push_back(campaign.device_plan);
    for (const std::size_t draw : draws)
      plans.back() = with_narrowed(std::move(plans.back()), draw, share);
  }
  counts.all_devices += plans.size() * options.rows;
  const std::size_t numbers = campaign.device_plan.parameters.size();
  const ScrambledSobol sobol(2 * numbers, options.seed);
  std::vector<std::vector<double>> found(
      plans.size(), std::vector<double>(options.rows, kNone));
  for_each_task(options.rows, thread_count(options.jobs),
                [&](std::size_t row, std::size_t) {
                  std::vector<double> a(numbers);
                  for (std::size_t n = 0; n < numbers; ++n)
                    a[n] = sobol.at(static_cast<std::uint32_t>(row), n);
                  for (std::size_t k = 0; k < plans.size(); ++k) {
                    const DrawnMerits drawn =
                        drawn_merits(campaign, plans[k], a, options, counts);
                    if (!drawn.values.empty())
                      found[k][row] = drawn.values.front();
                  }
                });
  return found;
}

}  // namespace beamgyro::internal
