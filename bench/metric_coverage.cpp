// SPDX-License-Identifier: MIT
// How often the intervals of the metrics hold the truth on the runs of a
// qualification:
//
//   beamgyro_coverage QUALIFICATION.toml DEVICE.toml MODEL.toml SEEDS
//     [METRIC...]
//
// The truth is what the same runs show without noise, those that have some also
// with a converter of 24 bits; of a figure of the noise itself, its root mean
// square over the seeds. The model is trained once, on the training runs.
// Prints, before and after compensation, how many intervals hold the truth, and
// how many lie below and above it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <thread>

#include "config/units.h"
#include "parallel/work_queue.h"
#include "sim/scenario/simulation_input.h"
#include "validation/external/compensator_source.h"
#include "validation/metrics/metric.h"
#include "validation/qualification/qualification_file.h"
#include "validation/result/device_evidence.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint64_t kSeedStep = 1000000;  // above every seed of a file
constexpr int kBitsOfTruth = 24;

const std::set<std::string_view> kFiguresOfNoise = {
    "normalised_residual",
    "turn_on_repeatability_deg_per_s",
    "in_run_stability_deg_per_s",
    "angle_random_walk_deg_per_sqrt_h",
    "bias_instability_deg_per_h",
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "rate_ramp_deg_per_h_per_h",
    "quantisation_deg",
    "bias_instability_bound_deg_per_h"};

/// The metrics of one set of runs, before and after compensation.
struct Found {
  std::vector<std::optional<Estimate>> before, after;
};

struct Study {
  Qualification qualification;
  QualifiedDevice device;
  std::shared_ptr<const TestedCompensator> compensator;
  std::vector<const Metric*> asked;

  Found found_with(const std::vector<QualificationRun>& runs,
                   const QualifiedDevice& unit) const {
    std::vector<ReadRun> read;
    for (const QualificationRun& run : runs)
      read.push_back({run.name, run.purpose, run.from});
    const DeviceEvidence evidence = answered_evidence(
        std::move(read), qualified_runs(runs, unit, 1),
        {*compensator, {}, unit.device.readout.full_scale / kDegree, true}, 1);
    Found found;
    for (const Metric* metric : asked) {
      found.before.push_back(metric->evaluate(evidence.before));
      found.after.push_back(metric->evaluate(evidence.after));
    }
    return found;
  }

  Found truth() const {
    std::vector<QualificationRun> noisy = qualification.runs;
    std::erase_if(noisy, [](const QualificationRun& run) {
      return !run.scenario.noise_enabled;
    });
    for (QualificationRun& run : noisy) {
      run.scenario.noise_enabled = false;
      run.overrides_text += "noise.enabled=false\n";
    }
    QualifiedDevice unit = device;
    unit.device.readout.adc_bits = kBitsOfTruth;
    Found found = found_with(noisy, unit);
    const Found exact = found_with(qualification.runs, device);
    for (std::size_t m = 0; m < asked.size(); ++m)
      if (!found.before[m]) {
        found.before[m] = exact.before[m];
        found.after[m] = exact.after[m];
      }
    return found;
  }

  Found of_seed(std::uint64_t seed) const {
    std::vector<QualificationRun> runs = qualification.runs;
    for (QualificationRun& run : runs) run.scenario.seed += kSeedStep * seed;
    return found_with(runs, device);
  }
};

/// One line of the table: a metric before or after compensation.
std::string counts(const std::vector<std::optional<Estimate>>& seeds,
                   const std::optional<Estimate>& quiet, bool of_noise) {
  int shown = 0, covered = 0, below = 0, above = 0;
  double squares = 0.0;
  std::vector<double> values, widths;
  for (const auto& one : seeds)
    if (one) {
      ++shown;
      squares += one->value * one->value;
      values.push_back(one->value);
    }
  if (shown == 0) return fmt::format("{:>5} shown", 0);
  if (!quiet && !of_noise) return "no truth";
  const double truth = of_noise ? std::sqrt(squares / shown) : quiet->value;
  for (const auto& one : seeds) {
    if (!one || !one->interval) continue;
    const auto [low, high] = *one->interval;
    if (high < truth)
      ++below;
    else if (low > truth)
      ++above;
    else
      ++covered;
    widths.push_back(high - low);
  }
  if (widths.empty()) return "no interval";
  std::ranges::sort(values);
  std::ranges::sort(widths);
  return fmt::format(
      "{:>4} of {:<4}{:>4} below{:>4} above{:>11.4g}{:>11.4g}{:>11.4g}",
      covered, shown, below, above, truth, values[values.size() / 2],
      widths[widths.size() / 2]);
}

int study_of(int argc, char** argv) {
  Study study;
  study.qualification = read_qualification(argv[1]);
  const LoadedDevice loaded = load_device(argv[2], {});
  study.device = {loaded.device, loaded.text};
  const ModelSpec model = read_model(std::filesystem::path(argv[3]));
  const std::size_t threads = std::thread::hardware_concurrency();
  study.compensator = tested(trained_on(
      training_data(study.qualification, study.device, &model, threads),
      model));
  for (const Metric& metric : metrics())
    if (!metric.is_of_sigma &&
        (argc == 5 || std::ranges::count(
                          std::vector<std::string_view>(argv + 5, argv + argc),
                          metric.name) > 0))
      study.asked.push_back(&metric);
  std::erase_if(study.qualification.runs, [&](const QualificationRun& run) {
    return std::ranges::none_of(study.asked, [&](const Metric* metric) {
      return std::ranges::count(metric->reads, run.purpose) > 0;
    });
  });
  const auto seeds = static_cast<std::size_t>(std::stoul(argv[4]));
  std::vector<Found> found(seeds);
  for_each_task(seeds, threads, [&](std::size_t k, std::size_t) {
    found[k] = study.of_seed(k + 1);
  });
  const Found truth = study.truth();
  for (std::size_t m = 0; m < study.asked.size(); ++m) {
    const bool of_noise = kFiguresOfNoise.contains(study.asked[m]->name);
    const auto print = [&](const char* when, auto member) {
      std::vector<std::optional<Estimate>> seen;
      for (const Found& one : found) seen.push_back((one.*member)[m]);
      fmt::print("{:<47}{:<7}{}\n", study.asked[m]->name, when,
                 counts(seen, (truth.*member)[m], of_noise));
    };
    print("before", &Found::before);
    print("after", &Found::after);
  }
  return 0;
}

}  // namespace
}  // namespace beamgyro::internal

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr,
               "expected QUALIFICATION.toml DEVICE.toml MODEL.toml SEEDS "
               "[METRIC...]\n");
    return 2;
  }
  return beamgyro::internal::study_of(argc, argv);
}
