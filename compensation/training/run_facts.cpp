// SPDX-License-Identifier: MIT
#include "compensation/training/run_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "compensation/training/cautions.h"
#include "dataset/recording/stated_values.h"

namespace beamgyro::internal {

RunSource noting(const RunSource& runs, RunFacts& facts) {
  return {
      runs.count, [&](const RunSource::Visitor& visit) {
        runs.for_each([&](const TrainingRun& run) {
          visit(run);  // whose errors name the run
          if (!run.sha256.empty()) facts.runs.push_back(mark_of(run));
          facts.coarsest_resolution = std::max(
              facts.coarsest_resolution, temperature_resolution(run.recording));
          const std::vector<double>& time = run.recording.time;
          if (time.size() > 1) {
            facts.longest = std::max(facts.longest, time.back() - time.front());
            facts.shortest_step = std::min(
                facts.shortest_step,
                facts.longest > 0.0 ? (time.back() - time.front()) /
                                          static_cast<double>(time.size() - 1)
                                    : HUGE_VAL);
          }
          if (std::string device = stated_device(run.recording);
              !device.empty())
            facts.devices.insert(std::move(device));
          else
            facts.states_devices = false;
          facts.may_remember =
              facts.may_remember || may_remember(run.recording);
          facts.age = std::max(facts.age, stated_age(run.recording));
        });
      }};
}

void require_bias(const TrainingRows& rows) {
  if (rows.size() == 0 || (rows.bias != 0.0).any()) return;
  throw std::invalid_argument(fmt::format(
      "the rate is the true rate in all {} rows, so that there is no drift to "
      "fit: is the channel connected? expected recordings of a gyro that "
      "drifts",
      rows.size()));
}

void require_filters(const std::vector<Input>& inputs, const RunFacts& facts) {
  constexpr double kFar = 100.0;
  for (const Input& input : inputs) {
    if (input.kind != InputKind::kLowpass &&
        input.kind != InputKind::kTemperatureRate)
      continue;
    if (facts.longest > 0.0 && input.parameter > kFar * facts.longest)
      throw std::invalid_argument(fmt::format(
          "input \"{}\": hardly moves within {:g} s, the longest recording; "
          "expected a time constant of at most {:g} s",
          input_name(input), facts.longest, kFar * facts.longest));
    if (input.kind == InputKind::kLowpass &&
        input.parameter * kFar < facts.shortest_step)
      throw std::invalid_argument(fmt::format(
          "input \"{}\": filters nothing of samples {:g} s apart; expected a "
          "time constant of that or more",
          input_name(input), facts.shortest_step));
  }
}

std::string warning_of_devices(const RunFacts& facts, bool is_population) {
  if (is_population || facts.devices.size() < 2) return "";
  return fmt::format(
      "the recordings are of {} different devices: one compensator fits their "
      "mean",
      facts.devices.size());
}

}  // namespace beamgyro::internal
