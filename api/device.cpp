// SPDX-License-Identifier: MIT
#include "include/beamgyro/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "api/device_state.h"
#include "api/key_overrides.h"
#include "sim/dynamics/characteristic.h"
#include "sim/scenario/simulation_input.h"
#include "sim/thermal/material_range.h"

namespace beamgyro {
namespace {

std::shared_ptr<const Device::State> state_of(
    internal::LoadedDevice loaded, std::string name,
    std::vector<std::string> overrides) {
  auto state = std::make_shared<Device::State>();
  state->text = std::move(loaded.text);
  state->name = std::move(name);
  state->overrides = std::move(overrides);
  state->device = loaded.device;
  return state;
}

void require_material_temperatures(std::span<const double> temperatures) {
  for (const double celsius : temperatures)
    if (!internal::kMaterialTemperatures.contains(celsius))
      throw std::invalid_argument(fmt::format(
          "{} degC is beyond {:g} to {:g} degC, {}", celsius,
          internal::kMaterialTemperatures.low,
          internal::kMaterialTemperatures.high, internal::kMaterialReason));
}

}  // namespace

Device::Device(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Device Device::read(const std::filesystem::path& file,
                    const std::vector<std::string>& overrides) {
  return Device(state_of(internal::load_device(file, overrides), file.string(),
                         overrides));
}

Device Device::parse(const std::string& text, const std::string& name,
                     const std::vector<std::string>& overrides) {
  return Device(state_of(
      internal::load_device(internal::InputText{text, name}, overrides), name,
      overrides));
}

Device Device::with(const std::vector<std::string>& overrides) const {
  return parse(text(), name(),
               internal::merged_overrides(state_->overrides, overrides));
}

const std::string& Device::text() const { return state_->text; }
const std::string& Device::name() const { return state_->name; }
const std::vector<std::string>& Device::overrides() const {
  return state_->overrides;
}

Characteristic characterise(const Device& device,
                            std::span<const double> temperatures_degC) {
  require_material_temperatures(temperatures_degC);
  const Device::State& state = device.state();
  Characteristic found;
  found.temperature.assign(temperatures_degC.begin(), temperatures_degC.end());
  for (const internal::CharacteristicQuantity& about :
       internal::characteristic_quantities())
    found.columns.push_back(
        {std::string(about.name), std::string(about.units), {}});
  const std::vector<internal::CharacteristicRow> rows =
      internal::characteristic(state.gyro.of(state.device), temperatures_degC);
  for (const internal::CharacteristicRow& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      found.columns[i].values.push_back(row[i]);
  found.csv = internal::characteristic_csv(temperatures_degC, rows);
  const bool is_linear =
      std::ranges::all_of(temperatures_degC, [](double celsius) {
        return internal::kLinearCeramic.contains(celsius);
      });
  if (!is_linear)
    found.warnings.push_back(fmt::format(
        "{}: beyond {:g} to {:g} degC the ceramic's coefficients keep the "
        "values of the nearest end",
        state.name, internal::kLinearCeramic.low,
        internal::kLinearCeramic.high));
  return found;
}

}  // namespace beamgyro
