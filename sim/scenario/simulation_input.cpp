// SPDX-License-Identifier: MIT
#include "sim/scenario/simulation_input.h"

#include <fmt/format.h>

#include <utility>

#include "config/document.h"
#include "config/file_error.h"
#include "sim/device/device_file.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

namespace {

LoadedDevice device_of(const ConfigDocument& document, const Overrides& set) {
  LoadedDevice loaded{read_device(document), document.text()};
  document.reject_unknown_keys();
  set.check_all_used();
  return loaded;
}

Scenario scenario_of(const ConfigDocument& document) {
  Scenario scenario = read_scenario(document);
  document.reject_unknown_keys();
  return scenario;
}

LoadedScenario loaded(Scenario scenario, const ConfigDocument& document,
                      const ConfigDocument& unit, const Overrides& set) {
  LoadedDevice device = device_of(unit, set);
  return {std::move(scenario),    device.device, document.text(),
          std::move(device.text), set.text(),    profile_files(document)};
}

}  // namespace

LoadedDevice load_device(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  return device_of(ConfigDocument::read(path, set), set);
}

LoadedDevice load_device(const InputText& input,
                         const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  return device_of(ConfigDocument::parse(input.text, input.name, set), set);
}

LoadedScenario load_scenario(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(path, set);
  const Scenario scenario = scenario_of(document);
  if (!std::filesystem::exists(status_of(scenario.device_file)))
    document.root().fail("device",
                         fmt::format("there is no file {}; expected one, named "
                                     "relative to the scenario",
                                     scenario.device_file.string()));
  LoadedScenario input = loaded(
      scenario, document, ConfigDocument::read(scenario.device_file, set), set);
  input.files.insert(input.files.end(), {path, scenario.device_file});
  return input;
}

LoadedScenario load_scenario(const InputText& scenario, const InputText& device,
                             const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  const ConfigDocument document =
      ConfigDocument::parse(scenario.text, scenario.name, set);
  return loaded(scenario_of(document), document,
                ConfigDocument::parse(device.text, device.name, set), set);
}

}  // namespace beamgyro::internal
