// SPDX-License-Identifier: MIT
#include "sim/campaign/shard_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "config/units.h"
#include "dataset/files/sha256.h"
#include "dataset/recording/signals.h"
#include "dataset/set/shard/shard_encoding.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {
namespace {

// The converter of a measured signal: value = count * step + offset.
struct Conversion {
  double step = 0, offset = 0;  // [units of the signal]; step 0: no counts
  double most = 0;  // [units], above all values; 0: the range follows from bits
  int bits = 0;
  std::vector<const char*> keys;  // of the device, that it depends on
};

// The converter of each measured signal.
std::map<std::string_view, Conversion> conversions(
    const DeviceParameters& device) {
  const ReadoutParameters& readout = device.readout;
  const double lsb =
      readout.full_scale / std::ldexp(1.0, readout.adc_bits - 1);  // [rad/s]
  const std::vector<const char*> of_output = {
      "readout.adc_bits", "readout.full_scale_deg_per_s",
      "readout.scale_factor_V_per_deg_per_s", "readout.offset_V"};
  return {
      {"output",
       {.step = readout.scale_factor * lsb,
        .offset = readout.offset,
        .bits = readout.adc_bits,
        .keys = of_output}},
      {"rate",
       {.step = lsb / kDegree, .bits = readout.adc_bits, .keys = of_output}},
      {"temperature",
       {.step = device.temperature_sensor.resolution,
        .most = 600,
        .keys = {"temperature_sensor.resolution_K"}}},
      {"drive_frequency",
       {.step = readout.drive_frequency_resolution,
        .most = 1e5,
        .keys = {"readout.drive_frequency_resolution_Hz"}}},
      {"drive_voltage",
       {.step = readout.drive_voltage_resolution,
        .most = 1e4,
        .keys = {"readout.drive_voltage_resolution_V"}}},
      {"quadrature",
       {.step = readout.quadrature_resolution / kDegree,
        .most = 1e6,
        .keys = {"readout.quadrature_resolution_deg_per_s"}}},
  };
}

// The shorter type whose counts reach `most`; floating point with a step too
// fine for that, or one that is not the same for all devices.
Storage storage_of(const Conversion& conversion, const CampaignPlan& campaign) {
  const auto holds = [&](int most_bits, double largest_count) {
    return conversion.most == 0
               ? conversion.bits <= most_bits
               : conversion.step * largest_count >= conversion.most;
  };
  const bool is_shared = std::ranges::none_of(
      conversion.keys, [&](const char* key) { return campaign.is_drawn(key); });
  if (conversion.step == 0 || !is_shared) return Storage::kFloat64;
  if (holds(16, std::numeric_limits<std::int16_t>::max()))
    return Storage::kInt16;
  if (holds(31, std::numeric_limits<std::int32_t>::max()))
    return Storage::kInt32;
  return Storage::kFloat64;
}

// How a variable of a recording is kept in a set: converters' counts as
// integers, truth at the campaign's precision and rate.
SetVariable set_variable(const CampaignPlan& campaign, const Column& column) {
  SetVariable variable;
  variable.name = column.name;
  variable.units = column.units;
  variable.long_name = column.long_name;
  variable.role = column.role;
  if (!column.comment.empty())
    variable.comment = "base device: " + column.comment;
  if (column.role == Role::kTruth) {
    variable.storage =
        campaign.output.double_precision || recorded_signal(column.name).is_fine
            ? Storage::kFloat64
            : Storage::kFloat32;
    variable.slow = column.name != "true_rate";
    return variable;
  }
  const Conversion conversion = conversions(campaign.base_device)[column.name];
  variable.storage = storage_of(conversion, campaign);
  if (variable.storage == Storage::kFloat64) return variable;
  variable.scale_factor = conversion.step;
  variable.add_offset = conversion.offset;
  return variable;
}

// Stands for those that some device may have; as weak as to change nothing.
SpuriousModeParameters any_spurious_mode() {
  return {.name = "any",
          .detuning = 0.1,
          .detuning_tc = 0,
          .loss_factor = 0.01,
          .coupling_drive = 1e-9,
          .coupling_sense = 0,
          .follows_housing = false};
}

// Returns the columns of a run of two samples of the base device, with every
// axis in motion that some device moves and with a spurious mode where some
// device may have one. So they do not depend on the values of any device.
std::vector<Column> columns_of(const CampaignPlan& campaign, std::size_t run) {
  ScenarioPlan scenario = campaign.runs[run].scenario;
  scenario.duration = 2 / scenario.output_rate;
  for (std::size_t i = kRateX; i < kCaseAxisCount; ++i)
    if (campaign.runs[run].moved_axes[i])
      scenario.motion[i] = PiecewiseLinear::constant(1e-3);
  DeviceParameters device = campaign.base_device;
  if (!device.loop_channels && campaign.is_drawn("loop_channels"))
    device.loop_channels.emplace();
  if (device.spurious_modes.empty() && campaign.is_drawn("spurious_mode"))
    device.spurious_modes.push_back(any_spurious_mode());
  return simulated(scenario, make_gyro(device)).columns;
}

std::size_t slow_step(const CampaignPlan& campaign,
                      const ScenarioPlan& scenario) {
  const double slow = campaign.output.truth_rate;
  if (slow == 0) return 1;
  return static_cast<std::size_t>(std::round(scenario.output_rate / slow));
}

}  // namespace

ShardPlan::ShardPlan(const CampaignPlan& campaign,
                     const ProgramRevision& program)
    : campaign_(&campaign) {
  const std::vector<std::string>& wanted = campaign.output.variables;
  std::vector<std::string> met;
  for (std::size_t r = 0; r < campaign.runs.size(); ++r) {
    const ScenarioPlan& scenario = campaign.runs[r].scenario;
    ShardHead head;
    head.slow_step = slow_step(campaign, scenario);
    columns_.emplace_back();
    for (const Column& column : columns_of(campaign, r)) {
      met.push_back(column.name);
      columns_.back().push_back(column.name);
      if (wanted.empty() ||
          std::ranges::find(wanted, column.name) != wanted.end())
        head.variables.push_back(set_variable(campaign, column));
    }
    head.compress = campaign.output.compress;
    head.run = campaign.runs[r].name;
    head.fidelity = fidelity_name(scenario.fidelity);
    head.program_version = program.version;
    head.git_revision = program.git_revision;
    head.seed = campaign.source.seed;
    heads_.push_back(std::move(head));
  }
  manifest_head_ = {
      .campaign = campaign.sources.front().path.filename().string(),
      .campaign_sha256 = sha256(campaign.text),
      .program_version = program.version,
      .git_revision = program.git_revision,
      .seed = campaign.source.seed,
      .devices = campaign.devices,
      .devices_per_file = campaign.devices_per_file,
      .runs = {},
      .sources = source_entries(campaign.sources)};
  for (const CampaignRun& run : campaign.runs)
    manifest_head_.runs.push_back(run.name);
  for (const std::string& name : wanted) {
    if (std::ranges::find(met, name) == met.end())
      throw std::invalid_argument(fmt::format(
          "{}: no run has a variable \"{}\"; "
          "expected some of {}",
          campaign.output.variables_place, name, fmt::join(met, ", ")));
  }
}

std::uint32_t ShardPlan::run_of(std::uint32_t file) const {
  return file % static_cast<std::uint32_t>(heads_.size());
}

std::uint32_t ShardPlan::range_of(std::uint32_t file) const {
  return file / static_cast<std::uint32_t>(heads_.size());
}

bool ShardPlan::has_column(std::uint32_t run, const std::string& name) const {
  return std::ranges::find(columns_[run], name) != columns_[run].end();
}

ShardHead ShardPlan::head_of(std::uint32_t file) const {
  const ManifestEntry entry = expected_entry(manifest_head_, file);
  const CampaignRun& run = campaign_->runs[run_of(file)];
  ShardHead head = heads_[run_of(file)];
  head.first_device = entry.first_device;
  head.devices = entry.devices;
  head.time = sample_times(run.scenario);
  head.parameters = campaign_->device_plan.parameters;
  std::ranges::copy(run.plan.parameters, std::back_inserter(head.parameters));
  head.campaign_text = campaign_->text;
  head.scenario_text = run.document.text();
  head.device_text = campaign_->device_document->text();
  return head;
}

std::uint64_t ShardPlan::device_runs(
    const std::vector<std::uint32_t>& files) const {
  std::uint64_t count = 0;
  for (const std::uint32_t file : files)
    count += expected_entry(manifest_head_, file).devices;
  return count;
}

double ShardPlan::run_duration() const {
  double sum = 0;
  for (std::size_t r = 0; r < heads_.size(); ++r)
    sum += campaign_->runs[r].scenario.duration;
  return sum / static_cast<double>(heads_.size());
}

double ShardPlan::largest_file() const {
  double largest = 0;
  for (std::size_t r = 0; r < heads_.size(); ++r) {
    const ShardHead& head = heads_[r];
    const auto samples =
        static_cast<double>(sample_count(campaign_->runs[r].scenario));
    double bytes = samples;  // status
    for (const SetVariable& variable : head.variables)
      bytes += static_cast<double>(width_of(variable.storage)) * samples /
               (variable.slow ? static_cast<double>(head.slow_step) : 1);
    largest = std::max(largest, bytes * std::min(campaign_->devices_per_file,
                                                 campaign_->devices));
  }
  return largest;
}

}  // namespace beamgyro::internal
