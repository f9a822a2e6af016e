// SPDX-License-Identifier: MIT
#include "sim/campaign/shard_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

#include "config/units.h"
#include "dataset/files/sha256.h"
#include "sim/scenario/simulation.h"

namespace beamgyro {
namespace {

// Stores counts of a converter if all devices have the same step, otherwise
// floating point.
void store_counts(double step, double offset, Storage counts, bool shared,
                  SetVariable& variable) {
  if (!shared || step == 0) {
    variable.storage = Storage::kFloat64;
    return;
  }
  variable.storage = counts;
  variable.scale_factor = step;
  variable.add_offset = offset;
}

void store_output(const Campaign& campaign, SetVariable& variable) {
  const ReadoutParameters& readout = campaign.base_device().readout;
  const auto is_drawn = [&](const char* key) { return campaign.is_drawn(key); };
  const bool shared = std::ranges::none_of(
      std::array{"readout.adc_bits", "readout.full_scale_deg_per_s",
                 "readout.scale_factor_V_per_deg_per_s", "readout.offset_V"},
      is_drawn);
  const double lsb =
      readout.full_scale / std::ldexp(1.0, readout.adc_bits - 1);  // [rad/s]
  const Storage counts =
      readout.adc_bits <= 16 ? Storage::kInt16 : Storage::kInt32;
  if (variable.name == "rate") {
    store_counts(lsb / kDegree, 0, counts, shared && readout.adc_bits < 32,
                 variable);
  } else {
    store_counts(readout.scale_factor * lsb, readout.offset, counts,
                 shared && readout.adc_bits < 32, variable);
  }
}

// How a variable of a recording is kept in a set: converters' counts as
// integers, truth at the campaign's precision and rate.
SetVariable set_variable(const Campaign& campaign, const Column& column) {
  SetVariable variable;
  variable.name = column.name;
  variable.units = column.units;
  variable.long_name = column.long_name;
  variable.role = column.role;
  if (column.role == Role::kTruth) {
    variable.storage = campaign.output().double_precision ? Storage::kFloat64
                                                          : Storage::kFloat32;
    variable.slow = column.name != "true_rate";
    return variable;
  }
  const Device& device = campaign.base_device();
  const ReadoutParameters& readout = device.readout;
  // The shorter type whose counts reach `most`, which no value does; with a
  // step too fine for that, floating point.
  const auto store = [&](double step, double most, const char* key) {
    const bool is_short =
        step * std::numeric_limits<std::int16_t>::max() >= most;
    const bool fits = step * std::numeric_limits<std::int32_t>::max() >= most;
    store_counts(step, 0, is_short ? Storage::kInt16 : Storage::kInt32,
                 fits && !campaign.is_drawn(key), variable);
  };
  if (column.name == "output" || column.name == "rate") {
    store_output(campaign, variable);
  } else if (column.name == "temperature") {
    store(device.temperature_sensor.resolution, 600,
          "temperature_sensor.resolution_K");
  } else if (column.name == "drive_frequency") {
    store(readout.drive_frequency_resolution, 1e5,
          "readout.drive_frequency_resolution_Hz");
  } else if (column.name == "drive_voltage") {
    store(readout.drive_voltage_resolution, 1e4,
          "readout.drive_voltage_resolution_V");
  } else if (column.name == "quadrature") {
    store(readout.quadrature_resolution / kDegree, 1e6,
          "readout.quadrature_resolution_deg_per_s");
  } else {
    variable.storage = Storage::kFloat64;
  }
  return variable;
}

template <std::size_t kAxes>
void set_moving(const std::array<bool, kAxes>& axes,
                std::array<RateProfile, kAxes>& profiles) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (axes[i]) profiles[i] = PiecewiseLinear::constant(1e-3);
  }
}

// Returns the columns of a run of two samples of the base device, with every
// axis in motion that some device moves. So they do not depend on the values of
// any device.
std::vector<Column> columns_of(const Campaign& campaign, std::size_t run) {
  Scenario scenario = campaign.base_scenario(run);
  scenario.duration = 2 / scenario.output_rate;
  const MovedAxes& axes = campaign.moved_axes(run);
  set_moving(axes.cross_rate, scenario.cross_rate);
  set_moving(axes.acceleration, scenario.acceleration);
  return simulated(scenario, make_gyro(campaign.base_device())).columns;
}

std::size_t slow_step(const Campaign& campaign, const Scenario& scenario) {
  const double slow = campaign.output().truth_rate;
  if (slow == 0) return 1;
  return static_cast<std::size_t>(std::round(scenario.output_rate / slow));
}

double bytes_of(Storage storage) {
  switch (storage) {
    case Storage::kFloat64:
      return 8;
    case Storage::kFloat32:
    case Storage::kInt32:
      return 4;
    case Storage::kInt16:
      return 2;
  }
  return 8;
}

}  // namespace

ShardPlan::ShardPlan(const Campaign& campaign, const ProgramRevision& program)
    : campaign_(&campaign) {
  const std::vector<std::string>& wanted = campaign.output().variables;
  std::vector<std::string> met;
  for (std::size_t r = 0; r < campaign.runs().size(); ++r) {
    const Scenario& scenario = campaign.base_scenario(r);
    ShardHead head;
    head.time = sample_times(scenario);
    head.slow_step = slow_step(campaign, scenario);
    columns_.emplace_back();
    for (const Column& column : columns_of(campaign, r)) {
      met.push_back(column.name);
      columns_.back().push_back(column.name);
      if (wanted.empty() ||
          std::ranges::find(wanted, column.name) != wanted.end())
        head.variables.push_back(set_variable(campaign, column));
    }
    for (const auto* drawn :
         {&campaign.parameters(), &campaign.run_parameters(r)}) {
      for (const DrawnParameter& parameter : *drawn)
        head.parameters.push_back(
            {parameter.name, parameter.units, parameter.long_name});
    }
    head.compress = campaign.output().compress;
    head.run = campaign.runs()[r].name;
    head.fidelity = fidelity_name(scenario.fidelity);
    head.program_version = program.version;
    head.git_revision = program.git_revision;
    head.seed = campaign.seed();
    head.campaign_text = campaign.text();
    head.scenario_text = campaign.runs()[r].scenario_text;
    head.device_text = campaign.device_text();
    heads_.push_back(std::move(head));
  }
  manifest_head_ = {
      .campaign = campaign.sources().front().path.filename().string(),
      .campaign_sha256 = sha256(campaign.text()),
      .program_version = program.version,
      .git_revision = program.git_revision,
      .seed = campaign.seed(),
      .devices = campaign.devices(),
      .devices_per_file = campaign.devices_per_file(),
      .runs = {},
      .sources = source_entries(campaign.sources())};
  for (const CampaignRun& run : campaign.runs())
    manifest_head_.runs.push_back(run.name);
  for (const std::string& name : wanted) {
    if (std::ranges::find(met, name) == met.end())
      throw std::invalid_argument(fmt::format(
          "{}: no run has a variable \"{}\"; "
          "expected some of {}",
          campaign.output().variables_place, name, fmt::join(met, ", ")));
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
  ShardHead head = heads_[run_of(file)];
  head.first_device = entry.first_device;
  head.devices = entry.devices;
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
    sum += campaign_->base_scenario(r).duration;
  return sum / static_cast<double>(heads_.size());
}

double ShardPlan::largest_file() const {
  double largest = 0;
  for (const ShardHead& head : heads_) {
    const auto samples = static_cast<double>(head.time.size());
    double bytes = samples;  // status
    for (const SetVariable& variable : head.variables)
      bytes += bytes_of(variable.storage) * samples /
               (variable.slow ? static_cast<double>(head.slow_step) : 1);
    largest = std::max(largest, bytes * std::min(campaign_->devices_per_file(),
                                                 campaign_->devices()));
  }
  return largest;
}

}  // namespace beamgyro
