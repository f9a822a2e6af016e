// SPDX-License-Identifier: MIT
#include "compensation/scoring/set_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/training_use.h"

namespace beamgyro::internal {
namespace {

struct MedianAndWorst {
  double median, worst;  // [deg/s]
};

MedianAndWorst spread_of(std::vector<double> values) {
  for (double& value : values)
    if (std::isnan(value)) value = HUGE_VAL;  // no answer is the worst
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.back()};
}

std::vector<double> each(const std::vector<DeviceScore>& scores,
                         double DeviceScore::*figure) {
  std::vector<double> values;
  for (const DeviceScore& score : scores) values.push_back(score.*figure);
  return values;
}

std::vector<std::string> runs_in_order(const std::vector<DeviceScore>& scores) {
  std::vector<std::string> runs;
  for (const DeviceScore& score : scores)
    if (std::find(runs.begin(), runs.end(), score.run) == runs.end())
      runs.push_back(score.run);
  return runs;
}

std::vector<DeviceScore> of_run(const std::vector<DeviceScore>& scores,
                                const std::string& run) {
  std::vector<DeviceScore> own;
  std::copy_if(scores.begin(), scores.end(), std::back_inserter(own),
               [&](const DeviceScore& score) { return score.run == run; });
  return own;
}

}  // namespace

std::vector<DeviceScore> score_devices(const Compensator& compensator,
                                       const RunSource& runs,
                                       const Specification& specification) {
  if (runs.count == 0)
    throw std::invalid_argument("no run of the set to score");
  std::vector<DeviceScore> scores;
  runs.for_each([&](const TrainingRun& run) {
    const Validation validation =
        validate(compensator, run.name,
                 {{run.name, &run.recording, run.sha256}}, specification);
    const Score& score = validation.overall;
    DeviceScore device{run.device,
                       run.run,
                       score.residual.rms,
                       score.raw.rms,
                       score.baseline ? score.baseline->rms : HUGE_VAL,
                       score.constant.rms};
    device.verdict = validation.verdict;
    device.passed = validation.passed();
    device.clamped = clamped_samples(compensator, run.recording);
    device.in_sample = validation.runs[0].in_sample ||
                       (runs.set && was_used_in_training(compensator.provenance,
                                                         *runs.set, run));
    device.worse_than = better_fits(score);
    if (score.replayed) device.not_tested = score.replayed->untested;
    scores.push_back(std::move(device));
  });
  return scores;
}

std::string device_table(const std::vector<DeviceScore>& scores) {
  std::string text = fmt::format(
      "{:24}{:>8}{:>18}{:>18}{:>18}{:>8}\n{:32}{:>18}{:>18}{:>18}\n",
      "rms [deg/s] of devices", "devices", "residual", "raw", "claimed cubic",
      "passed", "", "median    worst", "median    worst", "median    worst");
  auto out = std::back_inserter(text);
  for (const std::string& run : runs_in_order(scores)) {
    const std::vector<DeviceScore> own = of_run(scores, run);
    const auto passed = std::count_if(
        own.begin(), own.end(), [](const auto& score) { return score.passed; });
    fmt::format_to(out, "{:24}{:8}", run, own.size());
    for (const auto figure : {&DeviceScore::residual_rms, &DeviceScore::raw_rms,
                              &DeviceScore::cubic_rms}) {
      const MedianAndWorst spread = spread_of(each(own, figure));
      fmt::format_to(out, "{:9.4f}{:9.4f}", spread.median, spread.worst);
    }
    fmt::format_to(out, "{:8}\n", passed);
  }
  const auto worse =
      std::count_if(scores.begin(), scores.end(), [](const auto& score) {
        return std::ranges::find(score.worse_than, "constant") !=
               score.worse_than.end();
      });
  if (worse > 0)
    fmt::format_to(out, "{} of {}: worse than a constant fitted to the run\n",
                   worse, scores.size());
  return text;
}

std::vector<std::string> warnings_of(const Compensator& compensator,
                                     const RunSource& runs,
                                     const std::vector<DeviceScore>& scores) {
  std::vector<std::string> warnings;
  const auto clamped =
      std::count_if(scores.begin(), scores.end(),
                    [](const DeviceScore& score) { return score.clamped > 0; });
  if (clamped > 0)
    warnings.push_back(fmt::format(
        "{} of {} runs have samples outside {:g} to {:g} degC, the "
        "temperatures seen in training; clamped",
        clamped, scores.size(), compensator.temperature_range.lowest,
        compensator.temperature_range.highest));
  const auto seen =
      std::count_if(scores.begin(), scores.end(),
                    [](const DeviceScore& score) { return score.in_sample; });
  if (seen > 0)
    warnings.push_back(fmt::format(
        "{} of {} runs are of devices that were used in training: these scores "
        "are in-sample and flatter the compensator",
        seen, scores.size()));
  if (const std::string warning =
          warning_of_no_training(compensator.provenance);
      !warning.empty())
    warnings.push_back(warning);
  if (runs.set && may_have_used(compensator.provenance, *runs.set))
    warnings.push_back(
        "the compensator was trained on this set and does not record on which "
        "devices: these scores may be in-sample");
  return warnings;
}

nlohmann::ordered_json to_json(const std::vector<DeviceScore>& scores) {
  // JSON has no infinity and no NaN: null stands for them.
  auto array = nlohmann::ordered_json::array();
  for (const DeviceScore& score : scores)
    array.push_back({{"device", score.device},
                     {"run", score.run},
                     {"residual_rms_deg_per_s", score.residual_rms},
                     {"raw_rms_deg_per_s", score.raw_rms},
                     {"cubic_rms_deg_per_s", score.cubic_rms},
                     {"constant_rms_deg_per_s", score.constant_rms},
                     {"verdict", verdict_text(score.verdict)},
                     {"passed", score.passed},
                     {"clamped_samples", score.clamped},
                     {"in_sample", score.in_sample},
                     {"worse_than", score.worse_than},
                     {"not_tested", score.not_tested}});
  return array;
}

}  // namespace beamgyro::internal
