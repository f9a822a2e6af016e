// SPDX-License-Identifier: MIT
#include "sim/scenario/simulation_input.h"

#include <fmt/format.h>

#include <utility>

#include "config/document.h"
#include "config/file_error.h"
#include "dataset/files/text_file.h"
#include "dataset/log/csv_file.h"
#include "sim/device/device_file.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

namespace {

// A device that is named by a scenario or a campaign may be any file.
void require_device(const ConfigDocument& document) {
  const auto has = [&](const char* key) {
    return document.value(key) != nullptr;
  };
  if (has("beam") || has("patches") || has("bond")) return;
  const char* const is = has("duration_s")   ? "is a scenario"
                         : has("tolerances") ? "is a campaign"
                                             : "has no table [beam]";
  throw std::invalid_argument(fmt::format("{}: {}; expected a device file",
                                          document.path().string(), is));
}

LoadedDevice device_of(const ConfigDocument& document, const Overrides& set) {
  require_device(document);
  LoadedDevice loaded{read_device(document), document.text()};
  document.reject_unknown_keys();
  set.check_all_used();
  return loaded;
}

/// A scenario, and the profiles that it names as they were read.
struct ReadScenario {
  ScenarioPlan scenario;
  ProfileTexts profiles;
};

ProfileTables tables_of(const ProfileTexts& texts) {
  ProfileTables tables;
  for (const auto& [path, text] : texts)
    tables.emplace(path, parse_csv(text, path));
  return tables;
}

ReadScenario scenario_of(const ConfigDocument& document,
                         const ProfileTexts& known) {
  ProfileTables tables = tables_of(known);
  // An error in a profile names its place in the scenario.
  ScenarioPlan scenario = read_scenario(document, &tables);
  document.reject_unknown_keys();
  ProfileTexts profiles;
  bool has_read = false;
  for (const std::filesystem::path& file : profile_files(document)) {
    const std::filesystem::path path = file.lexically_normal();
    const auto before = known.find(path);
    has_read = has_read || before == known.end();
    const std::string& text =
        profiles
            .emplace(path, before == known.end() ? read_text_file(file)
                                                 : before->second)
            .first->second;
    tables.try_emplace(path, parse_csv(text, path));
  }
  // A file may have changed since; the texts are what counts.
  if (has_read) scenario = read_scenario(document, &tables);
  return {std::move(scenario), std::move(profiles)};
}

LoadedScenario loaded(ReadScenario read, const ConfigDocument& document,
                      const ConfigDocument& unit, const Overrides& set) {
  LoadedDevice device = device_of(unit, set);
  return {std::move(read.scenario), device.device, document.text(),
          std::move(device.text),   set.text(),    profile_files(document),
          std::move(read.profiles)};
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
  ReadScenario read = scenario_of(document, {});
  const std::filesystem::path device = read.scenario.device_file;
  if (!std::filesystem::exists(status_of(device)))
    document.root().fail("device",
                         fmt::format("there is no file {}; expected one, named "
                                     "relative to the scenario",
                                     device.string()));
  LoadedScenario input =
      loaded(std::move(read), document, ConfigDocument::read(device, set), set);
  input.files.insert(input.files.end(), {path, device});
  return input;
}

LoadedScenario load_scenario(const InputText& scenario, const InputText& device,
                             const std::vector<std::string>& overrides,
                             const ProfileTexts& profiles) {
  Overrides set(overrides);
  const ConfigDocument document =
      ConfigDocument::parse(scenario.text, scenario.name, set);
  return loaded(scenario_of(document, profiles), document,
                ConfigDocument::parse(device.text, device.name, set), set);
}

ScenarioVariants::ScenarioVariants(const InputText& scenario,
                                   const InputText& device,
                                   const ProfileTexts& profiles)
    : scenario_document_(ConfigDocument::parse(scenario.text, scenario.name)),
      device_document_(ConfigDocument::parse(device.text, device.name)),
      tables_(tables_of(profiles)) {}

void ScenarioVariants::read(const std::vector<std::string>& overrides) {
  const Overrides set(overrides);
  const ConfigDocument document = scenario_document_.with(set);
  scenario_ = read_scenario(document, &tables_);
  document.reject_unknown_keys();
  std::vector<std::string> others = set.shared_or_unused();
  has_new_device_ = others != device_overrides_;
  if (!has_new_device_) return;
  device_overrides_.reset();
  device_ = device_of(device_document_.with(set), set).device;
  device_overrides_ = std::move(others);
}

}  // namespace beamgyro::internal
