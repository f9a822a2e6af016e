// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

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
