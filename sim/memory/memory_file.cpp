// SPDX-License-Identifier: MIT
#include "sim/memory/memory_file.h"

#include <algorithm>
#include <numeric>

#include "config/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kHour = 3600;  // [s]

RelaxationParameters read_relaxation(const ConfigTable& table) {
  return {
      .activation =
          table.number_or("activation_J_per_mol", 6e5, between(1e4, 3e6)),
      .nonlinearity = table.number_or("nonlinearity", 0.4, between(0, 1)),
      .modulus_per_K =
          table.number_or("modulus_per_K", 2e-3, between(-5e-3, 5e-3)),
      .initial_offset =
          table.optional_number("initial_offset_K", between(-40, 40)),
  };
}

std::array<double, kPlayOperators> read_play(
    const ConfigTable& table, std::string_view key,
    const std::array<double, kPlayOperators>& otherwise, const Range& range) {
  std::array<double, kPlayOperators> result = otherwise;
  if (table.has(key))
    std::ranges::copy(table.numbers(key, kPlayOperators, range),
                      result.begin());
  return result;
}

HysteresisParameters read_hysteresis(const ConfigTable& table) {
  HysteresisParameters parameters{
      .half_width = read_play(table, "half_width_K", {0.5, 1.5, 4, 10},
                              {0, 200, true, false}),
      .weight =
          read_play(table, "weight", {0.2, 0.3, 0.3, 0.2}, non_negative()),
      .stiffness = table.number_or("stiffness", 4e-7, between(-1e-4, 1e-4)),
      .loss = table.number_or("loss", 5e-8, between(-1e-4, 1e-4)),
      .mount_axis =
          table.number_or("mount_axis_deg", 0.01, between(-10, 10)) * kDegree,
  };
  const double sum =
      std::reduce(parameters.weight.begin(), parameters.weight.end());
  if (!(sum > 0))
    table.fail("weight", "every weight is 0; expected one above 0");
  for (double& w : parameters.weight) w /= sum;
  return parameters;
}

AgeingParameters read_ageing(const ConfigTable& table) {
  const auto per_decade = [&](std::string_view key, double otherwise) {
    return table.number_or(key, otherwise, between(-0.1, 0.1));
  };
  return {
      .activation =
          table.number_or("activation_J_per_mol", 5e4, between(0, 2e5)),
      .start =
          table.number_or("start_hours", 24, {0, 1e5, true, false}) * kHour,
      .trim_age =
          table.number_or("trim_age_hours", 2000, {0, 1e6, false, false}) *
          kHour,
      .patch_modulus = per_decade("patch_modulus_per_decade", 2e-3),
      .d31 = per_decade("d31_per_decade", -5e-3),
      .permittivity = per_decade("permittivity_per_decade", -1e-2),
      .mechanical_loss = per_decade("mechanical_loss_per_decade", -5e-2),
      .bond_modulus = per_decade("bond_modulus_per_decade", 3e-3),
      .mount_share = per_decade("mount_share_per_decade", 1e-2),
  };
}

}  // namespace

MemoryParameters read_memory(const ConfigTable& memory) {
  MemoryParameters parameters;
  if (const auto table = memory.optional_table("relaxation"))
    parameters.relaxation = read_relaxation(*table);
  if (const auto table = memory.optional_table("hysteresis"))
    parameters.hysteresis = read_hysteresis(*table);
  if (const auto table = memory.optional_table("ageing"))
    parameters.ageing = read_ageing(*table);
  return parameters;
}

}  // namespace beamgyro::internal
