// SPDX-License-Identifier: MIT
#include "validation/checks/declared_response.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/scale_factor.h"

namespace beamgyro::internal {
namespace {

constexpr double kTimeConstants = 8.0;  // leave 3e-4 of a step
constexpr double kFilterSamples = 3.0;

double time_constant(double bandwidth) {
  return 1.0 / (2.0 * std::numbers::pi * bandwidth);
}

bool all_finite(const Recording& run, const Answer& answer) {
  for (const SampleRange& stretch : powered_stretches(run))
    for (std::size_t k = stretch.begin; k < stretch.end; ++k)
      if (!std::isfinite(answer.rate[k])) return false;
  return true;
}

class ReadyCompensator final : public TestedCompensator {
 public:
  ReadyCompensator(const TestedCompensator& original, double ready_after)
      : original_(original), ready_after_(ready_after) {}

  std::vector<std::string> inputs() const override {
    return original_.inputs();
  }
  bool states_inputs() const override { return original_.states_inputs(); }
  bool is_timed() const override { return original_.is_timed(); }
  const Provenance* provenance() const override {
    return original_.provenance();
  }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override {
    std::vector<Answer> all = original_.answers(runs);
    for (std::size_t k = 0; k < all.size(); ++k)
      bridge_until_ready(*runs[k], ready_after_, all[k]);
    return all;
  }

 private:
  const TestedCompensator& original_;
  double ready_after_;  // [s]
};

}  // namespace

double DeclaredResponse::settling(double step) const {
  if (!filters()) return kSettlingTime;
  const double low_pass =
      bandwidth ? kTimeConstants * time_constant(*bandwidth) : 0.0;
  return std::max({kSettlingTime, delay + low_pass, kFilterSamples * step});
}

double DeclaredResponse::least_gain(double frequency) const {
  return bandwidth ? 1.0 / std::hypot(1.0, frequency / *bandwidth) : 1.0;
}

double DeclaredResponse::most_delay(double frequency) const {
  if (!bandwidth) return delay;
  return delay + std::atan(frequency / *bandwidth) /
                     (2.0 * std::numbers::pi * frequency);
}

std::vector<double> DeclaredResponse::filtered(
    const Recording& run, const std::vector<double>& rate) const {
  std::vector<double> result = rate;
  if (!filters()) return result;
  for (const SampleRange& stretch : powered_stretches(run)) {
    std::size_t late = stretch.begin;  // the last sample before the delay
    double low = rate[stretch.begin];
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      while (late < k && run.time[late + 1] <= run.time[k] - delay) ++late;
      const double step =
          k > stretch.begin ? run.time[k] - run.time[k - 1] : 0.0;
      const double share =
          bandwidth ? step / (step + time_constant(*bandwidth)) : 1.0;
      low += share * (rate[late] - low);
      result[k] = low;
    }
  }
  return result;
}

std::string DeclaredResponse::words() const {
  std::string words;
  const auto add = [&words](const char* key, double value) {
    if (value != 0.0)
      words +=
          fmt::format("{}{} = {:.3g}", words.empty() ? "" : ", ", key, value);
  };
  add("bandwidth_Hz", bandwidth.value_or(0.0));
  add("delay_s", delay);
  add("ready_after_s", ready_after);
  add("zeroes_at_power_on_s", zeroes_at_power_on);
  add("resolution_deg_per_s", resolution);
  return words;
}

void bridge_until_ready(const Recording& run, double ready_after,
                        Answer& answer) {
  if (ready_after <= 0.0) return;
  const auto& rate = column_values(run, "rate");
  answer.rate.resize(run.time.size(), std::nan(""));
  for (const SampleRange& stretch : powered_stretches(run)) {
    std::size_t ready = stretch.begin;
    while (ready < stretch.end &&
           run.time[ready] - run.time[stretch.begin] <= ready_after)
      ++ready;
    const double correction =
        ready < stretch.end && std::isfinite(answer.rate[ready])
            ? rate[ready] - answer.rate[ready]
            : 0.0;
    for (std::size_t k = stretch.begin; k < ready; ++k)
      answer.rate[k] = rate[k] - correction;
  }
  std::erase_if(answer.faults, [&](const SeenFault& seen) {
    return seen.fault == AnswerFault::kNotFinite && all_finite(run, answer);
  });
}

std::unique_ptr<const TestedCompensator> ready_compensator(
    const TestedCompensator& original, double ready_after) {
  if (!(ready_after > 0.0)) return nullptr;
  return std::make_unique<ReadyCompensator>(original, ready_after);
}

}  // namespace beamgyro::internal
