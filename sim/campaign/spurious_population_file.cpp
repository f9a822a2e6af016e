// SPDX-License-Identifier: MIT
#include "sim/campaign/spurious_population_file.h"

#include <fmt/format.h>

#include <utility>

#include "config/units.h"
#include "sim/campaign/distribution_file.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kCountKey = "count";

void read_count(const ConfigTable& table, SpuriousPopulation& population) {
  FileDistribution read = read_distribution(table, kCountKey);
  for (const ConfigNode& value : read.values) {
    if (value.kind == ConfigNode::Kind::kInteger && value.integer >= 0 &&
        value.integer <= static_cast<long>(kMostSpuriousModes)) {
      population.counts.push_back(static_cast<int>(value.integer));
      continue;
    }
    table.fail(
        kCountKey,
        fmt::format("{} is no number of modes; expected whole numbers in "
                    "[0, {}]",
                    text_of(value), kMostSpuriousModes));
  }
  if (population.counts.empty())
    table.fail(kCountKey,
               "expected a whole number: poisson or discrete = { .. }");
  if (population.most() == 0)
    table.fail(kCountKey, "no unit has a mode; expected counts above 0");
  population.count = std::move(read.distribution);
}

Distribution read_of_mode(const ConfigTable& table, std::string_view key) {
  FileDistribution read = read_distribution(table, key);
  if (!read.values.empty())
    table.fail(key, "expected normal, uniform or lognormal = { .. }");
  return std::move(read.distribution);
}

}  // namespace

Draw read_spurious_population(const ConfigTable& root,
                              const TrimmedGyro& base) {
  const ConfigTable table = root.table("spurious_modes");
  SpuriousPopulation population;
  read_count(table, population);
  for (std::size_t k = 0; k < kSpuriousNumbers; ++k)
    population.of_mode[k] = read_of_mode(table, kSpuriousNumberKeys[k]);
  const Distribution& ratio = population.of_mode[kCouplingRatio];
  if (ratio.either_sign || !(ratio.low >= 0) ||
      (ratio.low == 0 && ratio.kind != Distribution::Kind::kLognormal)) {
    table.fail(kSpuriousNumberKeys[kCouplingRatio],
               "may be 0 or below, but is a ratio of magnitudes; expected a "
               "lognormal distribution or low above 0");
  }
  population.follow_housing =
      table.choice_or("follows", "beam", {"beam", "housing"}) == "housing";
  const double w_0 = beam_signal(base, kCalibrationTemperature, {})
                         .drive_frequency;  // [rad/s]
  population.product_per_height = 2 * base.beam.angular_gain * kDegree / w_0;

  Draw draw;
  draw.path = {"spurious_mode"};
  draw.place = root.position("spurious_modes");
  draw.distribution = population.count;
  draw.elements = population.numbers();
  draw.modes = std::move(population);
  return draw;
}

}  // namespace beamgyro::internal
