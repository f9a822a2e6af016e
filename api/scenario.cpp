// SPDX-License-Identifier: MIT
#include "include/beamgyro/scenario.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "api/scenario_state.h"
#include "api/shared_maker.h"
#include "config/overrides.h"
#include "dataset/files/text_file.h"
#include "sim/scenario/simulation.h"

namespace beamgyro {
namespace internal {

void require_no_device_key(const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides)
    if (key_of_override(text) == "device")
      reject_override(text, "the device is in memory; expected it as a Device");
}

}  // namespace internal

namespace {

Scenario scenario_of(internal::InputText scenario, internal::InputText device,
                     std::vector<std::string> device_overrides,
                     std::vector<std::string> overrides,
                     const internal::ProfileTexts& profiles) {
  internal::require_no_device_key(overrides);
  auto state = std::make_shared<internal::ScenarioState>();
  state->loaded = internal::load_scenario(
      scenario, device, internal::merged_overrides(device_overrides, overrides),
      profiles);
  state->scenario = std::move(scenario);
  state->device = std::move(device);
  state->device_overrides = std::move(device_overrides);
  state->overrides = std::move(overrides);
  return internal::SharedMaker::make<Scenario>(std::move(state));
}

}  // namespace

Scenario Scenario::read(const std::filesystem::path& file,
                        const std::vector<std::string>& overrides) {
  auto state = std::make_shared<internal::ScenarioState>();
  state->loaded = internal::load_scenario(file, overrides);
  state->scenario = {state->loaded.scenario_text, file.string()};
  state->device = {state->loaded.device_text,
                   state->loaded.scenario.device_file.string()};
  state->overrides = overrides;
  return internal::SharedMaker::make<Scenario>(std::move(state));
}

Scenario Scenario::read(const std::filesystem::path& file, const Device& device,
                        const std::vector<std::string>& overrides) {
  return parse(internal::read_text_file(file), device, overrides,
               file.string());
}

Scenario Scenario::parse(const std::string& text, const Device& device,
                         const std::vector<std::string>& overrides,
                         const std::string& name,
                         const std::vector<InputFile>& profiles) {
  internal::ProfileTexts texts;
  for (const InputFile& file : profiles)
    texts.emplace(file.path.lexically_normal(), file.text);
  return scenario_of({text, name}, {device.text(), device.name()},
                     device.overrides(), overrides, texts);
}

Scenario Scenario::with(const std::vector<std::string>& overrides) const {
  internal::require_no_device_key(overrides);
  std::vector<std::string> all = content().overrides;
  std::erase_if(all, [](const std::string& text) {  // it has been read
    return internal::key_of_override(text) == "device";
  });
  return scenario_of(
      content().scenario, content().device, content().device_overrides,
      internal::merged_overrides(all, overrides), content().loaded.profiles);
}

Scenario Scenario::with(std::string_view key, const Value& value) const {
  return with({override_of(key, value)});
}

Scenario Scenario::with_device(const Device& device) const {
  return parse(text(), device, content().overrides, name(), profiles());
}

std::string Scenario::text() const { return content().scenario.text; }
std::string Scenario::name() const { return content().scenario.name; }
Device Scenario::device() const {
  return Device::parse(content().device.text, content().device.name,
                       content().device_overrides);
}
std::vector<std::string> Scenario::overrides() const {
  return content().overrides;
}
std::vector<std::filesystem::path> Scenario::files() const {
  return content().loaded.files;
}
std::vector<InputFile> Scenario::profiles() const {
  std::vector<InputFile> all;
  for (const auto& [path, text] : content().loaded.profiles)
    all.push_back({path, text});
  return all;
}

std::string Scenario::title() const {
  return internal::title_of(content().loaded.scenario);
}
double Scenario::duration() const { return content().loaded.scenario.duration; }
double Scenario::output_rate() const {
  return content().loaded.scenario.output_rate;
}
std::size_t Scenario::samples() const {
  return internal::sample_count(content().loaded.scenario);
}
std::string Scenario::fidelity() const {
  return std::string(
      internal::fidelity_name(content().loaded.scenario.fidelity));
}
std::uint64_t Scenario::seed() const { return content().loaded.scenario.seed; }

double Scenario::estimated_seconds() const {
  const internal::ScenarioPlan& scenario = content().loaded.scenario;
  return scenario.fidelity == internal::Fidelity::kCarrier
             ? internal::carrier_cost(
                   scenario, content().gyro.of(content().loaded.device))
             : 0.0;
}

}  // namespace beamgyro
