// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "dataset/recording/recording.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

inline bool same_bits(const Recording& a, const Recording& b) {
  return a.time == b.time && a.status == b.status &&
         std::ranges::equal(
             a.columns, b.columns, [](const Column& x, const Column& y) {
               return x.values.size() == y.values.size() &&
                      std::memcmp(x.values.data(), y.values.data(),
                                  x.values.size() * sizeof(double)) == 0;
             });
}

/// A short scenario at 25 degC and rest with `extra` TOML after it.
inline ScenarioPlan scenario_from(
    const std::string& extra,
    const std::string& ambient = "[ambient]\nconstant_degC = 25\n",
    const std::string& duration = "100", const std::string& rate = "10") {
  Overrides overrides;
  const ConfigDocument document = ConfigDocument::parse(
      "name = \"test\"\ndevice = \"devices/nominal.toml\"\n"
      "fidelity = \"quasistatic\"\nduration_s = " +
          duration + "\noutput_rate_Hz = " + rate + "\nseed = 7\n" + ambient +
          extra,
      std::string(BEAMGYRO_SCENARIOS) + "/test.toml", overrides);
  const ScenarioPlan scenario = read_scenario(document);
  document.reject_unknown_keys();
  return scenario;
}

}  // namespace beamgyro::internal
