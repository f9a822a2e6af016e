// SPDX-License-Identifier: MIT
// How often the intervals of the metrics hold the truth on the runs of a
// qualification:
//
//   beamgyro_coverage QUALIFICATION.toml DEVICE.toml MODEL.toml FIRST LAST
//     [METRIC...]
//
// Seeds go from FIRST to LAST. The truth is what the same runs show without
// noise, those that have some also with a converter of 24 bits; of a figure of
// the noise itself, its root mean square over the seeds; of a figure that
// depends on the random rates, which follow the seed, what the runs of each
// seed show without the noise of the rate, but with that of the temperature
// sensor. The model is trained once, on the training runs. Prints,
// before and after compensation, how many intervals hold the truth, how many
// lie below and above it, and medians of the truth, of the figure and of the
// width.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "parallel/work_queue.h"
#include "tests/validation/metrics/seeded_runs.h"

namespace beamgyro::internal {
namespace {

const std::set<std::string_view> kFiguresOfNoise = {
    "normalised_residual",
    "turn_on_repeatability_deg_per_s",
    "in_run_stability_deg_per_s",
    "angle_random_walk_deg_per_sqrt_h",
    "bias_instability_deg_per_h",
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "rate_ramp_deg_per_h_per_h",
    "quantisation_deg",
    "bias_instability_bound_deg_per_h",
    "white_noise_ratio"};

const std::set<std::string_view> kFiguresOfRates = {
    "scale_factor_retained", "scale_factor_retained_small_rates"};

using Figures = std::vector<std::optional<Estimate>>;  // of one metric, by seed

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// The root mean square of the figures, for each of them.
Figures usual(const Figures& seeds) {
  int shown = 0;
  double squares = 0.0;
  for (const auto& one : seeds)
    if (one) {
      ++shown;
      squares += one->value * one->value;
    }
  return Figures(seeds.size(), Estimate{std::sqrt(squares / shown)});
}

/// One line of the table: a metric before or after compensation.
std::string counts(const Figures& seeds, const Figures& truths) {
  int shown = 0, covered = 0, below = 0, above = 0;
  std::vector<double> values, widths, true_values;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    if (!seeds[k]) continue;
    ++shown;
    if (!seeds[k]->interval || !truths[k]) continue;
    const auto [low, high] = *seeds[k]->interval;
    const double truth = truths[k]->value;
    ++(high < truth ? below : low > truth ? above : covered);
    values.push_back(seeds[k]->value);
    widths.push_back(high - low);
    true_values.push_back(truth);
  }
  if (shown == 0) return "not shown";
  if (widths.empty()) return "no interval or no truth";
  return fmt::format(
      "{:>4} of {:<4}{:>4} below{:>4} above{:>13.6g}{:>13.6g}{:>11.4g}",
      covered, shown, below, above, median(true_values), median(values),
      median(widths));
}

std::vector<const Metric*> asked_for(std::span<char*> names) {
  std::vector<const Metric*> asked;
  for (const Metric& metric : metrics())
    if (!metric.is_of_sigma &&
        (names.empty() || std::ranges::any_of(names, [&](const char* name) {
           return metric.name == name;
         })))
      asked.push_back(&metric);
  return asked;
}

void print_study(std::span<char*> arguments) {
  const std::size_t threads = std::thread::hardware_concurrency();
  const SeededRuns runs(arguments[0], arguments[1], arguments[2],
                        asked_for(arguments.subspan(5)), threads);
  const std::uint64_t first = std::stoul(arguments[3]);
  const std::size_t seeds = std::stoul(arguments[4]) + 1 - first;
  const bool own = std::ranges::any_of(runs.asked(), [](const Metric* metric) {
    return kFiguresOfRates.contains(metric->name);
  });
  const FoundMetrics quiet = runs.quiet(first);
  std::vector<FoundMetrics> noisy(seeds), own_truth(seeds);
  for_each_task(seeds, threads, [&](std::size_t k, std::size_t) {
    noisy[k] = runs.noisy(first + k);
    if (own) own_truth[k] = runs.without_rate_noise(first + k);
  });
  for (std::size_t m = 0; m < runs.asked().size(); ++m) {
    const std::string_view name = runs.asked()[m]->name;
    const auto print = [&](const char* when, auto member) {
      const bool of_rates = kFiguresOfRates.contains(name);
      Figures seen, truth;
      for (std::size_t k = 0; k < seeds; ++k) {
        seen.push_back((noisy[k].*member)[m]);
        truth.push_back(((of_rates ? own_truth[k] : quiet).*member)[m]);
      }
      if (kFiguresOfNoise.contains(name)) truth = usual(seen);
      fmt::print("{:<47}{:<7}{}\n", name, when, counts(seen, truth));
    };
    print("before", &FoundMetrics::before);
    print("after", &FoundMetrics::after);
  }
}

}  // namespace
}  // namespace beamgyro::internal

int main(int argc, char** argv) {
  if (argc < 6) {
    fmt::print(stderr,
               "expected QUALIFICATION.toml DEVICE.toml MODEL.toml FIRST LAST "
               "[METRIC...]\n");
    return 2;
  }
  beamgyro::internal::print_study(
      std::span(argv + 1, static_cast<std::size_t>(argc - 1)));
  return 0;
}
