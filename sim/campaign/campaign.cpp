// SPDX-License-Identifier: MIT
#include "sim/campaign/campaign.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "config/units.h"
#include "random/random_stream.h"
#include "sim/device/device_file.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Lets `work` fill in `result`. A rejected value or a failed simulation becomes
// the failure of the device.
template <class Result, class Work>
void attempt(Result& result, const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    result.failure = one_line(error.what());
  } catch (const SimulationFailure& error) {
    result.failure = one_line(error.what());
  }
}

// The name has no folder, because failures are data and must not depend on
// where the files are.
ConfigDocument drawn_from(const ConfigDocument& file, Overrides& overrides) {
  return file.with(overrides, file.path().filename().string());
}

void add_as_built(const CampaignPlan& campaign, DeviceParameters device,
                  Overrides& overrides) {
  const Trims& trims = campaign.trims;
  set_as_built(trims, *campaign.base_gyro, device);
  const auto add = [&](const char* key, double value) {
    overrides.add({"readout", key}, number_node(value));
  };
  const ReadoutParameters& readout = device.readout;
  if (!trims.quadrature)
    add("quadrature_trim_deg_per_s", readout.quadrature_trim / kDegree);
  if (!trims.scale_factor)
    add("scale_factor_error", readout.scale_factor_error);
  if (!trims.offset)
    add("offset_trim_deg_per_s", readout.offset_trim / kDegree);
}

VirtualDevice built_device(const CampaignPlan& campaign, const DrawPlan& plan,
                           DrawnValues drawn) {
  VirtualDevice result;
  result.parameters = std::move(drawn.parameters);
  Overrides overrides = overrides_of(plan, drawn.values);
  attempt(result, [&] {
    const ConfigDocument& document = *campaign.device_document;
    DeviceParameters device = read_device(drawn_from(document, overrides));
    if (campaign.base_gyro) {
      add_as_built(campaign, device, overrides);
      device = read_device(drawn_from(document, overrides));
    }
    result.device = device;
  });
  result.overrides = overrides.text();
  return result;
}

// Whether `table` is a part of the path of `key`, or `key` itself.
bool holds(std::string_view table, std::string_view key) {
  return key.starts_with(table) &&
         (key.size() == table.size() || key[table.size()] == '.');
}

const ConfigNode* below(const ConfigNode& node, std::string_view key) {
  const ConfigNode* at = &node;
  while (at != nullptr && !key.empty()) {
    const std::size_t dot = std::min(key.find('.'), key.size());
    at = find_child(*at, key.substr(0, dot));
    key.remove_prefix(std::min(dot + 1, key.size()));
  }
  return at;
}

bool is_same(const ConfigNode* a, const ConfigNode* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return toml_text(*a) == toml_text(*b);
}

bool is_choice(const Draw& draw) {
  return !draw.values.empty() && draw.elements == 0;
}

void add_moving(const ScenarioPlan& scenario, PerAxis<bool>& axes) {
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    axes[i] |= moves(scenario.motion[i]);
}

}  // namespace

void set_as_built(const Trims& trims, const TrimmedGyro& base,
                  DeviceParameters& device) {
  ReadoutParameters& readout = device.readout;
  if (!trims.quadrature)
    readout.quadrature_trim = built_quadrature(device, base.stiffness_trim);
  if (trims.scale_factor && trims.offset) return;
  if (!trims.scale_factor) readout.scale_factor_error = 0;
  const TrimmedGyro gyro = make_gyro(device);
  double gain = 1;
  if (!trims.scale_factor) {
    gain = std::abs(gyro.rate_axis) / std::abs(base.rate_axis);
    readout.scale_factor_error = gain - 1;
  }
  if (!trims.offset) {
    const double untrimmed = readout.offset_trim - gyro.offset;  // [rad/s]
    readout.offset_trim = gain * untrimmed + base.offset;
  }
}

PerAxis<bool> moved_axes(const ScenarioPlan& scenario,
                         const ConfigDocument& document, const DrawPlan& plan,
                         const ProfileTables& profiles) {
  PerAxis<bool> axes{};
  add_moving(scenario, axes);
  for (const Draw& draw : plan.draws) {
    const std::string key = key_of(draw);
    if (!is_choice(draw)) {
      for (std::size_t i = 0; i < kCaseAxisCount; ++i)
        axes[i] |= holds(kCaseAxes[i].key, key) || holds(key, kCaseAxes[i].key);
      continue;
    }
    if (!holds("cross_rate", key) && !holds("acceleration", key)) continue;
    double before = 0;
    for (std::size_t i = 0; i < draw.values.size(); ++i) {
      const bool is_ever_drawn = draw.distribution.cumulative[i] > before;
      before = draw.distribution.cumulative[i];
      if (!is_ever_drawn) continue;
      Overrides choice;
      choice.add(draw.path, draw.values[i], draw.place);
      add_moving(read_scenario(document.with(choice), &profiles), axes);
    }
  }
  return axes;
}

bool CampaignPlan::is_drawn(std::string_view key) const {
  return std::ranges::any_of(device_plan.draws, [&](const Draw& draw) {
    const std::string drawn = key_of(draw);
    if (holds(key, drawn)) return true;
    if (!holds(drawn, key)) return false;
    if (draw.modes) return true;
    const ConfigNode* in_file = device_document->value(key);
    return !std::ranges::all_of(draw.values, [&](const ConfigNode& choice) {
      return is_same(below(choice, key.substr(drawn.size() + 1)), in_file);
    });
  });
}

VirtualDevice CampaignPlan::device(std::uint32_t index) const {
  return built_device(*this, device_plan,
                      drawn_values(device_plan, source, index));
}

VirtualDevice CampaignPlan::device_at(const DrawPlan& plan,
                                      std::vector<double> uniform) const {
  return built_device(*this, plan, drawn_values(plan, std::move(uniform)));
}

VirtualRun CampaignPlan::run(std::size_t run, std::uint32_t device) const {
  const CampaignRun& base = runs.at(run);
  VirtualRun result;
  if (base.plan.draws.empty()) {
    result.scenario = base.scenario;
    return result;
  }
  DrawnValues drawn = drawn_values(base.plan, source, device);
  result.parameters = std::move(drawn.parameters);
  Overrides overrides = overrides_of(base.plan, drawn.values);
  attempt(result, [&] {
    result.scenario = read_scenario(base.document.with(overrides), &profiles);
    result.scenario->seed = source.seed;
  });
  result.overrides = overrides.text();
  return result;
}

Part CampaignPlan::part(std::uint32_t device) const {
  RandomStream stream(source.seed, device, stream_number("split"),
                      kDeviceDrawStream);
  return static_cast<Part>(static_cast<int>(quantile(split, stream.uniform())));
}

}  // namespace beamgyro::internal
