// SPDX-License-Identifier: MIT
#include "sim/scenario/simulation_input.h"

#include <fmt/format.h>

#include <utility>

#include "config/document.h"
#include "config/file_error.h"
#include "sim/device/device_file.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

LoadedDevice load_device(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(path, set);
  LoadedDevice loaded{read_device(document), document.text()};
  document.reject_unknown_keys();
  set.check_all_used();
  return loaded;
}

LoadedScenario load_scenario(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(path, set);
  const Scenario scenario = read_scenario(document);
  document.reject_unknown_keys();
  if (!std::filesystem::exists(status_of(scenario.device_file)))
    document.root().fail("device",
                         fmt::format("there is no file {}; expected one, named "
                                     "relative to the scenario",
                                     scenario.device_file.string()));
  const ConfigDocument unit = ConfigDocument::read(scenario.device_file, set);
  const Device device = read_device(unit);
  unit.reject_unknown_keys();
  set.check_all_used();
  std::vector<std::filesystem::path> files = profile_files(document);
  files.insert(files.end(), {path, scenario.device_file});
  return {scenario,    device,     document.text(),
          unit.text(), set.text(), std::move(files)};
}

}  // namespace beamgyro::internal
