// SPDX-License-Identifier: MIT
#include "tests/validation/metrics/seeded_runs.h"

#include <algorithm>
#include <utility>

#include "config/units.h"
#include "sim/scenario/simulation_input.h"
#include "validation/external/compensator_source.h"
#include "validation/qualification/qualification_file.h"
#include "validation/result/device_evidence.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint64_t kSeedStep = 1000000;  // above every seed of a file
constexpr int kBitsWithoutNoise = 24;

}  // namespace

SeededRuns::SeededRuns(const std::filesystem::path& qualification,
                       const std::filesystem::path& device,
                       const std::filesystem::path& model,
                       std::vector<const Metric*> asked, std::size_t threads)
    : asked_(std::move(asked)),
      qualification_(read_qualification(qualification)) {
  const LoadedDevice loaded = load_device(device.string(), {});
  device_ = {loaded.device, loaded.text};
  const ModelSpec spec = read_model(model);
  compensator_ = tested(
      trained_on(training_data(qualification_, device_, &spec, threads), spec));
  std::erase_if(qualification_.runs, [&](const QualificationRun& run) {
    return std::ranges::none_of(asked_, [&](const Metric* metric) {
      return std::ranges::count(metric->reads, run.purpose) > 0;
    });
  });
}

std::vector<QualificationRun> SeededRuns::runs_of(std::uint64_t seed) const {
  std::vector<QualificationRun> runs = qualification_.runs;
  for (QualificationRun& run : runs) run.scenario.seed += kSeedStep * seed;
  return runs;
}

FoundMetrics SeededRuns::noisy(std::uint64_t seed) const {
  return found_in(qualified_runs(runs_of(seed), device_, 1));
}

FoundMetrics SeededRuns::quiet(std::uint64_t seed) const {
  QualifiedDevice fine = device_;
  fine.device.readout.adc_bits = kBitsWithoutNoise;
  std::vector<Recording> recordings;
  for (QualificationRun& run : runs_of(seed)) {
    const bool has_noise = run.scenario.noise_enabled;
    if (has_noise) {
      run.scenario.noise_enabled = false;
      run.overrides_text += "noise.enabled=false\n";
    }
    recordings.push_back(std::move(
        qualified_runs({run}, has_noise ? fine : device_, 1).front()));
  }
  return found_in(std::move(recordings));
}

FoundMetrics SeededRuns::without_rate_noise(std::uint64_t seed) const {
  QualifiedDevice fine = device_;
  fine.device.noise = {};
  fine.device.readout.adc_bits = kBitsWithoutNoise;
  return found_in(qualified_runs(runs_of(seed), fine, 1));
}

FoundMetrics SeededRuns::found_in(std::vector<Recording> recordings) const {
  std::vector<ReadRun> read;
  for (const QualificationRun& run : qualification_.runs)
    read.push_back({run.name, run.purpose, run.from});
  const DeviceEvidence evidence = answered_evidence(
      std::move(read), std::move(recordings),
      {*compensator_, {}, device_.device.readout.full_scale / kDegree, true},
      1);
  FoundMetrics found;
  for (const Metric* metric : asked_) {
    found.before.push_back(metric->evaluate(evidence.before));
    found.after.push_back(metric->evaluate(evidence.after));
  }
  return found;
}

}  // namespace beamgyro::internal
