// SPDX-License-Identifier: MIT
#include "sim/device/spurious_mode_file.h"

#include <fmt/format.h>

#include <optional>

namespace beamgyro::internal {
namespace {

// The frequency of a mode stays above 0 at every beam temperature.
constexpr double kMostDetuning = 0.1, kMostDetuningTc = 5e-3;  // [-] [1/K]
constexpr double kMostCoupling = 0.01;
constexpr Range kLossFactor{1e-5, 0.5};

// A change of the detuning, which needs the memory effect that drives it.
double read_change(const ConfigTable& mode, std::string_view key, bool is_on,
                   std::string_view effect) {
  const double change = mode.number_or(key, 0, between(-0.1, 0.1));
  if (change != 0 && !is_on) {
    mode.fail(key, fmt::format("{} has no effect without [memory.{}]; add that "
                               "table or remove this key",
                               change, effect));
  }
  return change;
}

SpuriousModeParameters read_mode(const ConfigTable& mode,
                                 const std::string& name,
                                 const MemoryParameters& memory) {
  const auto coupling = [&](std::string_view key) {
    return mode.number(key, between(-kMostCoupling, kMostCoupling));
  };
  return {
      .name = name,
      .detuning =
          mode.number("detuning", between(-kMostDetuning, kMostDetuning)),
      .detuning_tc = mode.number("detuning_tc_per_K",
                                 between(-kMostDetuningTc, kMostDetuningTc)),
      .loss_factor = mode.number("loss_factor", kLossFactor),
      .coupling_drive = coupling("coupling_drive"),
      .coupling_sense = coupling("coupling_sense"),
      .follows_housing =
          mode.choice_or("follows", "beam", {"beam", "housing"}) == "housing",
      .drift = read_change(mode, "detuning_per_decade",
                           memory.ageing.has_value(), "ageing"),
      .slip = read_change(mode, "detuning_slip", memory.hysteresis.has_value(),
                          "hysteresis"),
  };
}

}  // namespace

std::vector<SpuriousModeParameters> read_spurious_modes(
    const ConfigTable& root, const MemoryParameters& memory) {
  std::vector<SpuriousModeParameters> modes;
  const std::optional<ConfigTable> tables =
      root.optional_table("spurious_mode");
  if (!tables) return modes;
  const std::vector<std::string> names = tables->keys();
  if (names.size() > kMostSpuriousModes) {
    root.fail("spurious_mode", fmt::format("{} modes; expected at most {}",
                                           names.size(), kMostSpuriousModes));
  }
  for (const std::string& name : names) {
    SpuriousModeParameters mode = read_mode(tables->table(name), name, memory);
    if (mode.coupling_drive == 0 && mode.coupling_sense == 0) continue;
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace beamgyro::internal
