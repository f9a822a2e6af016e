// SPDX-License-Identifier: MIT
#include "sim/campaign/shard_making.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "parallel/work_queue.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {
namespace {

// Adds what the samples of one run of a device show.
void count(std::span<const std::uint8_t> status, CautionCounts& cautions) {
  std::size_t powered = 0, unlocked = 0, saturated = 0;
  for (const std::uint8_t bits : status) {
    const bool is_powered = (bits & kUnpowered) == 0;
    powered += is_powered;
    unlocked += is_powered && (bits & kLoopNotLocked) != 0;
    saturated += (bits & kOutputSaturated) != 0;
  }
  cautions.unpowered += powered == 0;
  cautions.not_locked += powered > 0 && 2 * unlocked >= powered;
  cautions.saturated += saturated > 0;
}

void fail(DeviceRow& row, const std::string& why, DeviceStatus status) {
  row.failure = why.substr(0, why.find('\n'));  // its first line
  row.device_status = status;
}

// A variable that is zero for a device that does not have it: motion about or
// along an axis that its run does not move, and the bias of spurious modes.
bool is_zero_where_absent(const std::string& name) {
  return name == "true_spurious_bias" ||
         std::ranges::find(kCaseAxes.begin() + kRateX, kCaseAxes.end(), name,
                           &AxisNames::column) != kCaseAxes.end();
}

}  // namespace

void ShardMaker::prepare(std::uint32_t range) {
  if (range_ == range) return;
  range_.reset();
  prepared_.clear();
  const CampaignPlan& campaign = plan_.campaign();
  const std::uint32_t first = range * campaign.devices_per_file;
  const std::uint32_t last =
      std::min(first + campaign.devices_per_file, campaign.devices);
  for (std::uint32_t d = first; d < last; ++d) {
    PreparedDevice device{campaign.device(d), {}, {}};
    device.row.part = static_cast<std::uint8_t>(campaign.part(d));
    if (!device.drawn.device) {
      fail(device.row, device.drawn.failure, kInvalidParameters);
    } else {
      try {
        device.gyro = make_gyro(*device.drawn.device);
      } catch (const SimulationFailure& error) {
        fail(device.row, error.what(), kNoConvergence);
      }
    }
    prepared_.push_back(std::move(device));
  }
  range_ = range;
}

// Simulates one device in one run; `row` says why when that fails.
Recording ShardMaker::recorded(const PreparedDevice& device,
                               const VirtualRun& run, const RunKey& key,
                               const ShardHead& head, DeviceRow& row) const {
  Recording recording;
  if (!run.scenario) {
    fail(row, run.failure, kInvalidParameters);
    return recording;
  }
  try {
    recording = simulated(*run.scenario, *device.gyro, key);
  } catch (const std::invalid_argument& error) {
    fail(row, error.what(), kInvalidParameters);
    return recording;
  } catch (const SimulationFailure& error) {
    fail(row, error.what(), kNoConvergence);
    return recording;
  }
  for (const Column& column : recording.columns) {
    if (!plan_.has_column(key.run, column.name)) {
      throw std::logic_error(fmt::format(
          "device {}, run {}: {} is not among the variables planned for the "
          "set",
          key.device, head.run, column.name));
    }
  }
  for (const SetVariable& variable : head.variables) {
    if (is_zero_where_absent(variable.name) &&
        !find_column(recording, variable.name)) {
      recording.columns.push_back(
          {variable.name, variable.units, variable.long_name, variable.role,
           std::vector<double>(recording.time.size(), 0.0)});
    }
  }
  return recording;
}

// Values that are not finite or that their storage cannot hold are a failure of
// the device, too.
EncodedDevice ShardMaker::encoded(const ShardBuilder& file,
                                  std::uint32_t position,
                                  const PreparedDevice& device,
                                  const VirtualRun& run, const RunKey& key,
                                  DeviceRow& row,
                                  CautionCounts& cautions) const {
  if (row.failure.empty()) {
    const Recording recording = recorded(device, run, key, file.head(), row);
    try {
      if (row.failure.empty()) {
        count(recording.status, cautions);
        return file.encode(position, row, &recording);
      }
    } catch (const UnstorableSamples& error) {
      fail(row, error.what(), kNotFinite);
    }
  }
  return file.encode(position, row, nullptr);
}

MadeShard ShardMaker::make(std::uint32_t file, GenerationCounts& counts) {
  const std::uint32_t run = plan_.run_of(file);
  const ShardHead head = plan_.head_of(file);
  prepare(plan_.range_of(file));
  MadeShard made;
  made.file = std::make_unique<ShardBuilder>(head);
  for (std::uint32_t i = 0; i < head.devices; ++i) {
    const PreparedDevice& device = prepared_[i];
    const std::uint32_t number = head.first_device + i;
    const VirtualRun drawn = plan_.campaign().run(run, number);
    DeviceRow row = device.row;
    row.parameters = device.drawn.parameters;
    row.parameters.insert(row.parameters.end(), drawn.parameters.begin(),
                          drawn.parameters.end());
    made.file->add(encoded(*made.file, i, device, drawn, {number, run}, row,
                           made.cautions));
    if (!row.failure.empty()) {
      made.failures.push_back({number, row.failure});
      ++counts.failures;
    }
    ++counts.device_runs;
    if (counts.on_device_run) counts.on_device_run();
  }
  made.bytes = made.file->finish();
  return made;
}

void generate_shards(const ShardPlan& plan,
                     const std::vector<std::uint32_t>& files, unsigned jobs,
                     GenerationCounts& counts, const ShardSink& publish) {
  const std::size_t threads =
      std::min<std::size_t>(thread_count(jobs), files.size());
  std::vector<std::optional<ShardMaker>> makers(threads);  // one per thread
  for_each_task(files.size(), threads,
                [&](std::size_t index, std::size_t worker) {
                  std::optional<ShardMaker>& maker = makers[worker];
                  if (!maker) maker.emplace(plan);
                  publish(files[index], maker->make(files[index], counts));
                });
}

}  // namespace beamgyro::internal
