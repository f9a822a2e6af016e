// SPDX-License-Identifier: MIT
#include "sensitivity/study/sensitivity_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

std::vector<double> logarithms(std::vector<double> values) {
  for (double& value : values)
    value =
        value > 0 ? std::log(value) : std::numeric_limits<double>::quiet_NaN();
  return values;
}

MeritSample studied(const MeritSample& sample, bool of_logarithm) {
  if (!of_logarithm) return sample;
  MeritSample result;
  result.design.a = logarithms(sample.design.a);
  result.design.b = logarithms(sample.design.b);
  for (const std::vector<double>& values : sample.design.ab)
    result.design.ab.push_back(logarithms(values));
  result.independent = logarithms(sample.independent);
  return result;
}

std::array<double, 3> quantiles_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {percentile(values, 0.05), percentile(values, 0.5),
          percentile(values, 0.95)};
}

YieldResult yield_of(const DeviceSample& sample, const MeritSample& values,
                     double limit) {
  YieldResult yield{limit, share_within(values.design.a, limit), {}};
  for (std::size_t k = 0; k < sample.keys.size(); ++k) {
    HalvedYield halved{sample.keys[k], {}};
    if (!values.halved[k].empty())
      halved.share = share_within(values.halved[k], limit);
    yield.halved.push_back(halved);
  }
  std::stable_sort(yield.halved.begin(), yield.halved.end(),
                   [](const HalvedYield& one, const HalvedYield& other) {
                     const auto value = [](const HalvedYield& each) {
                       return each.share ? each.share->value : -1;
                     };
                     return value(one) > value(other);
                   });
  return yield;
}

}  // namespace

DeviceShare share_within(const std::vector<double>& values, double limit) {
  const auto passed = static_cast<double>(
      std::count_if(values.begin(), values.end(),
                    [&](double value) { return std::abs(value) <= limit; }));
  const auto count = static_cast<double>(values.size());
  return {passed / count, clopper_pearson(passed, count)};
}

MeritResult analysed(const DeviceSample& sample, std::size_t index,
                     const MeritQuestion& question, std::uint64_t seed) {
  const MeritSample& values = sample.merits[index];
  const MeritSample of = studied(values, question.of_logarithm);
  const PickFreezeIndices indices = pick_freeze_indices(of.design, seed);
  MeritResult result;
  result.merit = question.merit;
  result.of_logarithm = question.of_logarithm;
  result.rows = indices.rows;
  result.samples = of.design.a.size();
  result.variance = indices.variance;
  if (indices.rows == 0)
    throw std::runtime_error(fmt::format("{}: no device of {} works: {}",
                                         figure_of_merit(question.merit).name,
                                         sample.devices, sample.first_failure));
  result.quantiles = quantiles_of(values.design.a);
  for (std::size_t i = 0; i < sample.factors.size(); ++i) {
    const FactorIndices& factor = indices.factors[i];
    result.sum_of_first += factor.first.value;
    result.factors.push_back({sample.factors[i].key, factor.first, factor.total,
                              rank_index(of.independent, sample.numbers[i]),
                              factor.total_by_product, factor.rows});
  }
  std::stable_sort(result.factors.begin(), result.factors.end(),
                   [](const FactorResult& one, const FactorResult& other) {
                     return one.total.value > other.total.value;
                   });
  if (question.limit) result.yield = yield_of(sample, values, *question.limit);
  return result;
}

}  // namespace beamgyro::internal
