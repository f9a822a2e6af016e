// SPDX-License-Identifier: MIT
#include "sim/campaign/campaign.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "config/units.h"
#include "random/random_stream.h"
#include "sim/campaign/campaign_file.h"
#include "sim/device/device_file.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/scenario_file.h"

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

void add_as_built(const CampaignState& campaign, DeviceParameters device,
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

VirtualDevice built_device(const CampaignState& campaign, const DrawPlan& plan,
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

}  // namespace

CampaignPlan::CampaignPlan(std::shared_ptr<const CampaignState> state)
    : state_(std::move(state)) {}

CampaignPlan CampaignPlan::read(const std::filesystem::path& file,
                                std::optional<long> devices) {
  return CampaignPlan(
      std::make_shared<const CampaignState>(read_campaign(file, devices)));
}

CampaignPlan CampaignPlan::of_copies(std::span<const SourceText> copies,
                                     std::optional<long> devices) {
  return CampaignPlan(
      std::make_shared<const CampaignState>(read_campaign(copies, devices)));
}

const std::string& CampaignPlan::name() const { return state_->name; }
const std::string& CampaignPlan::text() const { return state_->text; }
std::uint32_t CampaignPlan::devices() const { return state_->devices; }
std::uint32_t CampaignPlan::devices_per_file() const {
  return state_->devices_per_file;
}
std::uint64_t CampaignPlan::seed() const { return state_->source.seed; }
const CampaignOutput& CampaignPlan::output() const { return state_->output; }
const std::vector<CampaignRun>& CampaignPlan::runs() const {
  return state_->runs;
}
const DeviceParameters& CampaignPlan::base_device() const {
  return state_->device;
}
const std::string& CampaignPlan::device_text() const {
  return state_->device_document->text();
}
const ScenarioPlan& CampaignPlan::base_scenario(std::size_t run) const {
  return state_->scenarios.at(run);
}
const std::vector<SourceText>& CampaignPlan::sources() const {
  return state_->sources;
}
const std::vector<DeviceVariable>& CampaignPlan::parameters() const {
  return state_->device_plan.parameters;
}
const std::vector<DeviceVariable>& CampaignPlan::run_parameters(
    std::size_t run) const {
  return state_->run_plans.at(run).parameters;
}

bool CampaignPlan::is_drawn(std::string_view device_key) const {
  return internal::is_drawn(state_->device_plan, *state_->device_document,
                            device_key);
}
const MovedAxes& CampaignPlan::moved_axes(std::size_t run) const {
  return state_->moved_axes.at(run);
}

const DrawPlan& CampaignPlan::device_plan() const {
  return state_->device_plan;
}

VirtualDevice CampaignPlan::device(std::uint32_t index) const {
  const DrawPlan& plan = state_->device_plan;
  return built_device(*state_, plan, drawn_values(plan, state_->source, index));
}

VirtualDevice CampaignPlan::device_at(const DrawPlan& plan,
                                      std::vector<double> uniform) const {
  return built_device(*state_, plan, drawn_values(plan, std::move(uniform)));
}

VirtualRun CampaignPlan::run(std::size_t run, std::uint32_t device) const {
  const DrawPlan& plan = state_->run_plans.at(run);
  VirtualRun result;
  if (plan.draws.empty()) {
    result.scenario = state_->scenarios[run];
    return result;
  }
  DrawnValues drawn = drawn_values(plan, state_->source, device);
  result.parameters = std::move(drawn.parameters);
  Overrides overrides = overrides_of(plan, drawn.values);
  attempt(result, [&] {
    result.scenario = read_scenario(
        state_->scenario_documents[run].with(overrides), &state_->profiles);
    result.scenario->seed = seed();
  });
  result.overrides = overrides.text();
  return result;
}

Part CampaignPlan::part(std::uint32_t device) const {
  RandomStream stream(seed(), device, stream_number("split"),
                      kDeviceDrawStream);
  return static_cast<Part>(
      static_cast<int>(quantile(state_->split, stream.uniform())));
}

}  // namespace beamgyro::internal
