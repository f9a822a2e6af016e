// SPDX-License-Identifier: MIT
#include "dataset/set/shard/device_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "dataset/recording/recording_defect.h"
#include "dataset/set/shard/shard_encoding.h"

namespace beamgyro::internal {
namespace {

/// The row of one variable as it goes into the file, cut into chunks if it is
/// compressed. `fill` is one value that pads the last chunk.
std::vector<PackedChunk> chunks_of(std::vector<std::byte> row,
                                   const std::vector<std::byte>& fill,
                                   ChunkPacker* packer) {
  std::vector<PackedChunk> chunks;
  if (packer == nullptr) {
    chunks.push_back({std::move(row), 0});
    return chunks;
  }
  const std::size_t width = fill.size();
  const std::size_t size = chunk_length(row.size() / width) * width;
  while (row.size() % size != 0)
    row.insert(row.end(), fill.begin(), fill.end());
  for (std::size_t first = 0; first < row.size(); first += size) {
    chunks.push_back(packer->pack(std::span(row).subspan(first, size), width));
  }
  return chunks;
}

const std::vector<double>& values_of(const Recording& recording,
                                     const SetVariable& about) {
  const Column* column = find_column(recording, about.name);
  if (column == nullptr) throw std::runtime_error(about.name + " is missing");
  return column->values;
}

void check_recording(const ShardHead& head, const Recording* recording) {
  if (recording == nullptr) throw std::runtime_error("no recording");
  if (recording->time != head.time)
    throw std::runtime_error("the times are not those of the file");
  const std::string defect = samples_defect(*recording, 0);
  if (!defect.empty()) throw UnstorableSamples(defect);
}

void check_row(const ShardHead& head, const DeviceRow& row) {
  if (row.parameters.size() != head.parameters.size())
    throw std::runtime_error(fmt::format("{} parameters; expected {}",
                                         row.parameters.size(),
                                         head.parameters.size()));
  if (row.failure.empty() != (row.device_status == kDeviceOk))
    throw std::runtime_error(
        fmt::format("device_status {} with the failure '{}'", row.device_status,
                    row.failure));
}

std::vector<std::byte> row_of(const SetVariable& about, const ShardHead& head,
                              const Recording* recording) {
  const std::size_t step = about.slow ? head.slow_step : 1;
  if (recording != nullptr)
    return encoded_values(about, values_of(*recording, about), step);
  return fill_values(about, about.slow ? slow_length(head) : head.time.size());
}

EncodedDevice encoded(const ShardHead& head, const DeviceRow& row,
                      const Recording* recording) {
  std::unique_ptr<ChunkPacker> packer;
  if (head.compress) packer = std::make_unique<ChunkPacker>();
  EncodedDevice device{row, {}};
  device.variables.reserve(head.variables.size() + 1);
  std::vector<std::byte> status(head.time.size(), std::byte{kUnpowered});
  if (recording != nullptr) {
    std::transform(recording->status.begin(), recording->status.end(),
                   status.begin(), [](std::uint8_t s) { return std::byte{s}; });
  }
  device.variables.push_back(
      chunks_of(std::move(status), {std::byte{kUnpowered}}, packer.get()));
  for (const SetVariable& about : head.variables) {
    device.variables.push_back(chunks_of(row_of(about, head, recording),
                                         fill_values(about, 1), packer.get()));
  }
  return device;
}

}  // namespace

EncodedDevice encode_device(const ShardHead& head, std::uint32_t position,
                            const DeviceRow& row, const Recording* recording) {
  const auto placed = [&](const std::exception& error) {
    return fmt::format("device {}, run {}: {}", head.first_device + position,
                       head.run, error.what());
  };
  try {
    check_row(head, row);
    const bool has_failed = !row.failure.empty();
    if (!has_failed) check_recording(head, recording);
    return encoded(head, row, has_failed ? nullptr : recording);
  } catch (const UnstorableSamples& error) {
    throw UnstorableSamples(placed(error));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(placed(error));
  }
}

}  // namespace beamgyro::internal
