// SPDX-License-Identifier: MIT
#include "include/beamgyro/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "api/beam_temperatures.h"
#include "api/scenario_state.h"
#include "api/shared_maker.h"
#include "config/overrides.h"
#include "config/units.h"
#include "sim/dynamics/characteristic.h"
#include "sim/dynamics/spurious_bump.h"
#include "sim/scenario/simulation_input.h"

namespace beamgyro {
namespace {

constexpr std::size_t kMostTemperatures = 1000000;

Device device_of(internal::LoadedDevice loaded, std::string name,
                 std::vector<std::string> overrides) {
  auto state = std::make_shared<internal::DeviceState>();
  state->text = std::move(loaded.text);
  state->name = std::move(name);
  state->overrides = std::move(overrides);
  state->device = loaded.device;
  return internal::SharedMaker::make<Device>(std::move(state));
}

std::vector<SpuriousCrossing> crossings_of(
    const internal::TrimmedGyro& gyro,
    std::span<const double> temperatures_degC) {
  const auto [low, high] = std::ranges::minmax(temperatures_degC);
  std::vector<SpuriousCrossing> crossings;
  for (const internal::SpuriousBump& bump : internal::spurious_bumps(
           gyro, low + internal::kZeroCelsius, high + internal::kZeroCelsius))
    crossings.push_back({bump.mode, bump.temperature - internal::kZeroCelsius,
                         bump.height / internal::kDegree, bump.width});
  std::ranges::stable_sort(crossings, {}, &SpuriousCrossing::temperature);
  return crossings;
}

}  // namespace

Device Device::read(const std::filesystem::path& file,
                    const std::vector<std::string>& overrides) {
  return device_of(internal::load_device(file, overrides), file.string(),
                   overrides);
}

Device Device::parse(const std::string& text, const std::string& name,
                     const std::vector<std::string>& overrides) {
  return device_of(
      internal::load_device(internal::InputText{text, name}, overrides), name,
      overrides);
}

Device Device::with(const std::vector<std::string>& overrides) const {
  return parse(text(), name(),
               internal::merged_overrides(content().overrides, overrides));
}

Device Device::with(std::string_view key, const Value& value) const {
  return with({override_of(key, value)});
}

std::string Device::text() const { return content().text; }
std::string Device::name() const { return content().name; }
std::vector<std::string> Device::overrides() const {
  return content().overrides;
}

std::vector<double> even_temperatures(double start, double stop, double step) {
  for (const double number : {start, stop, step})
    if (!std::isfinite(number))
      throw std::invalid_argument(fmt::format(
          "{} is no finite number; expected START, STOP and STEP", number));
  const double steps = (stop - start) / step;
  if (!(steps >= 0.0) || step == 0.0)
    throw std::invalid_argument(
        fmt::format("a step of {:g} K does not lead from {:g} to {:g} degC",
                    step, start, stop));
  const double count = std::floor(steps + 1e-9) + 1.0;
  if (count > static_cast<double>(kMostTemperatures))
    throw std::invalid_argument(fmt::format(
        "a step of {:g} K makes {:g} temperatures from {:g} to {:g} degC; "
        "expected at most {}",
        step, count, start, stop, kMostTemperatures));
  std::vector<double> grid;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    grid.push_back(start + static_cast<double>(i) * step);
  // A last step may pass `stop` by a rounding.
  grid.back() =
      step > 0.0 ? std::min(grid.back(), stop) : std::max(grid.back(), stop);
  return grid;
}

namespace internal {
namespace {

void add_limit_warnings(const DeviceState& state,
                        std::span<const CharacteristicRow> rows,
                        std::vector<std::string>& warnings) {
  const CharacteristicLimits limits = limits_met(state.device, rows);
  if (limits.not_locked > 0)
    warnings.push_back(
        fmt::format("{}: at {} of {} temperatures the drive needs more than "
                    "drive.voltage_limit_V = {:g}; the loops do not lock there",
                    state.name, limits.not_locked, rows.size(),
                    state.device.drive.voltage_limit));
  if (limits.saturated > 0)
    warnings.push_back(fmt::format(
        "{}: at {} of {} temperatures the bias is beyond "
        "readout.full_scale_deg_per_s = {:g}; the output saturates there",
        state.name, limits.saturated, rows.size(),
        state.device.readout.full_scale / kDegree));
}

}  // namespace
}  // namespace internal

Characteristic characterise(const Device& device,
                            std::span<const double> temperatures_degC) {
  internal::require_material_temperatures(temperatures_degC);
  const internal::DeviceState& state = device.content();
  Characteristic found;
  found.temperature.assign(temperatures_degC.begin(), temperatures_degC.end());
  for (const internal::CharacteristicQuantity& about :
       internal::characteristic_quantities())
    found.columns.push_back(
        {std::string(about.name), std::string(about.units), {}});
  const auto& gyro = state.gyro.of(state.device);
  const std::vector<internal::CharacteristicRow> rows =
      internal::characteristic(gyro, temperatures_degC);
  for (const internal::CharacteristicRow& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      found.columns[i].values.push_back(row[i]);
  found.csv = internal::characteristic_csv(temperatures_degC, rows);
  found.crossings = crossings_of(gyro, temperatures_degC);
  found.warnings = internal::ceramic_warnings(temperatures_degC, state.name);
  internal::add_limit_warnings(state, rows, found.warnings);
  return found;
}

}  // namespace beamgyro
