// SPDX-License-Identifier: MIT
#include "dataset/set/shard/shard_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "dataset/recording/recording_defect.h"

namespace beamgyro::internal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance = 1e-6;  // of a count

template <class Value>
constexpr Value kFill = std::numeric_limits<Value>::is_integer
                            ? std::numeric_limits<Value>::lowest()
                            : std::numeric_limits<Value>::quiet_NaN();

/// Calls `work` with a value of the type that `storage` names.
template <class Work>
auto with_type(Storage storage, const Work& work) {
  switch (storage) {
    case Storage::kFloat64:
      return work(double{});
    case Storage::kFloat32:
      return work(float{});
    case Storage::kInt16:
      return work(std::int16_t{});
    case Storage::kInt32:
      break;
  }
  return work(std::int32_t{});
}

[[noreturn]] void refuse(const SetVariable& variable, double value,
                         std::size_t sample, const std::string& expected) {
  throw UnstorableSamples(fmt::format("{}: sample {} is {}; expected {}",
                                      variable.name, sample, value, expected));
}

/// The nearest whole number of |x| below 2^51; a call of the library would be
/// most of the encoding.
double rounded(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

template <class Count>
bool is_count(double x) {
  // The lowest 16-bit count is what a converter shows at its limit.
  constexpr double kLowest =
      static_cast<double>(kFill<Count>) + (sizeof(Count) == 2 ? 0 : 1);
  return x >= kLowest - kTolerance &&
         x <= static_cast<double>(std::numeric_limits<Count>::max()) +
                  kTolerance &&
         std::abs(x - rounded(x)) <= kTolerance;
}

template <class Count>
[[noreturn]] void refuse_counts(const SetVariable& variable, double value,
                                std::size_t sample) {
  refuse(variable, value, sample,
         fmt::format("{} + a whole number of {} from {} to {}",
                     variable.add_offset, variable.scale_factor,
                     kFill<Count> + 1, std::numeric_limits<Count>::max()));
}

template <class Value>
void put(Value value, std::byte* out) {
  std::memcpy(out, &value, sizeof value);
}

template <class Count>
Count encoded_count(const SetVariable& variable, double value,
                    std::size_t sample) {
  const double x = (value - variable.add_offset) / variable.scale_factor;
  if (is_count<Count>(x)) {
    const double count = rounded(x);
    return count <= kFill<Count> ? static_cast<Count>(kFill<Count> + 1)
                                 : static_cast<Count>(count);
  }
  if (!std::isnan(value)) refuse_counts<Count>(variable, value, sample);
  return kFill<Count>;
}

template <class Value>
void encode(const SetVariable& variable, const std::vector<double>& values,
            std::size_t step, std::byte* out) {
  for (std::size_t k = 0; k < values.size(); k += step, out += sizeof(Value)) {
    if constexpr (std::numeric_limits<Value>::is_integer) {
      put(encoded_count<Value>(variable, values[k], k), out);
    } else {
      const auto value = static_cast<Value>(values[k]);
      if (std::isinf(value))
        refuse(variable, values[k], k,
               fmt::format("at most {}", std::numeric_limits<Value>::max()));
      put(value, out);
    }
  }
}

}  // namespace

std::vector<double> slow_times(const ShardHead& head) {
  std::vector<double> times;
  for (std::size_t k = 0; k < head.time.size(); k += head.slow_step)
    times.push_back(head.time[k]);
  return times;
}

std::size_t slow_length(const ShardHead& head) {
  return (head.time.size() + head.slow_step - 1) / head.slow_step;
}

std::size_t chunk_length(std::size_t values) {
  constexpr std::size_t kLongest = std::size_t{128} << 10;
  const std::size_t chunks = (values + kLongest - 1) / kLongest;
  return (values + chunks - 1) / chunks;
}

std::size_t width_of(Storage storage) {
  return with_type(storage, [](auto value) { return sizeof value; });
}

std::string shard_head_defect(const ShardHead& head) {
  Recording names;
  const auto add = [&](const auto& about, Role role = Role::kMeasured) {
    names.columns.push_back(
        {about.name, about.units, about.long_name, role, {}});
  };
  for (const char* taken : {"device", "truth_time", "part", "device_status"})
    add(DeviceVariable{taken, "", ""});
  for (const DeviceVariable& parameter : head.parameters) add(parameter);
  for (const SetVariable& variable : head.variables)
    add(variable, variable.role);
  for (const std::string* text :
       {&head.run, &head.fidelity, &head.program_version, &head.git_revision,
        &head.campaign_text, &head.scenario_text, &head.device_text,
        &head.overrides_text})
    names.scenario_text += *text;
  if (std::string defect = head_defect(names); !defect.empty()) return defect;

  Recording times;
  times.time = head.time;
  times.status.resize(head.time.size());
  if (std::string defect = samples_defect(times, 0); !defect.empty())
    return defect;
  if (head.devices == 0) return "no devices; expected at least one";
  if (head.slow_step == 0) return "a slow step of 0; expected at least 1";
  for (const SetVariable& variable : head.variables) {
    if (!std::isfinite(variable.scale_factor) || variable.scale_factor == 0 ||
        !std::isfinite(variable.add_offset))
      return fmt::format("{}: scale factor {} and offset {}", variable.name,
                         variable.scale_factor, variable.add_offset);
  }
  return {};
}

std::vector<std::byte> encoded_values(const SetVariable& variable,
                                      const std::vector<double>& values,
                                      std::size_t step) {
  return with_type(variable.storage, [&](auto kind) {
    const std::size_t count = (values.size() + step - 1) / step;
    std::vector<std::byte> bytes(count * sizeof kind);
    encode<decltype(kind)>(variable, values, step, bytes.data());
    return bytes;
  });
}

std::vector<std::byte> fill_values(const SetVariable& variable,
                                   std::size_t count) {
  return with_type(variable.storage, [&](auto kind) {
    std::vector<std::byte> bytes(count * sizeof kind);
    for (std::size_t k = 0; k < count; ++k)
      put(kFill<decltype(kind)>, bytes.data() + k * sizeof kind);
    return bytes;
  });
}

std::vector<double> decoded_values(const SetVariable& variable,
                                   const std::vector<std::byte>& bytes) {
  return with_type(variable.storage, [&](auto kind) {
    using Value = decltype(kind);
    std::vector<double> values(bytes.size() / sizeof(Value));
    for (std::size_t k = 0; k < values.size(); ++k) {
      Value value{};
      std::memcpy(&value, bytes.data() + k * sizeof value, sizeof value);
      if constexpr (std::numeric_limits<Value>::is_integer) {
        values[k] = value == kFill<Value>
                        ? kNaN
                        : static_cast<double>(value) * variable.scale_factor +
                              variable.add_offset;
      } else {
        values[k] = static_cast<double>(value);
      }
    }
    return values;
  });
}

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
