// SPDX-License-Identifier: MIT
#include "dataset/set/shard/shard_builder.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_write.h"
#include "dataset/set/shard/shard_layout.h"

namespace beamgyro::internal {
namespace {

/// How a variable of rows of `length` values is stored.
H5Id row_properties(bool compress, std::size_t length) {
  H5Id properties = creation_properties(H5P_DATASET_CREATE);
  if (!compress) {
    check_hdf5(H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY),
               "place values");
    check_hdf5(H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER),
               "leave values open");
    return properties;
  }
  const std::array<hsize_t, 2> chunk = {1, chunk_length(length)};
  check_hdf5(H5Pset_chunk(properties, 2, chunk.data()), "choose chunks");
  check_hdf5(H5Pset_shuffle(properties), "choose shuffle");
  check_hdf5(H5Pset_deflate(properties, 1), "choose deflate");
  check_hdf5(H5Pset_fletcher32(properties), "choose fletcher32");
  return properties;
}

std::string failures_text(const ShardHead& head,
                          const std::vector<DeviceRow>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].failure.empty()) continue;
    const nlohmann::ordered_json line = {{"device", head.first_device + i},
                                         {"reason", rows[i].failure}};
    text += line.dump(-1, ' ', false,
                      nlohmann::ordered_json::error_handler_t::replace);
    text += '\n';
  }
  return text;
}

}  // namespace

class ShardBuilder::Image {
 public:
  explicit Image(const ShardHead& head) : head_(head), file_(make_image()) {
    write_root_attributes(file_, head);
    axes_.push_back(
        make_axis({"device", "1", "number of the device", Role::kTruth},
                  H5T_STD_I64LE, head.devices));
    axes_.push_back(
        make_axis({"time", "s", "time"}, H5T_IEEE_F64LE, head.time.size()));
    if (head.slow_step > 1) {
      axes_.push_back(make_axis({"truth_time", "s", "time of slow truth"},
                                H5T_IEEE_F64LE, slow_length(head)));
    }
    for (const DeviceVariable& about : head.parameters) {
      parameters_.push_back(make_device_variable(
          {about.name, about.units, about.long_name, Role::kTruth},
          H5T_IEEE_F64LE));
    }
    make_flags();
    make_rows();
  }

  void add(const EncodedDevice& device, std::size_t position) {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      write_row(rows_[i], device.variables[i], position);
  }

  std::span<const std::byte> finish(const std::vector<DeviceRow>& rows) {
    write_axes();
    write_device_variables(rows);
    const std::string failures = failures_text(head_, rows);
    const std::array<NamedText, 5> texts = {
        {{"campaign", head_.campaign_text},
         {"scenario", head_.scenario_text},
         {"device", head_.device_text},
         {"overrides", head_.overrides_text},
         {"failures", failures}}};
    write_meta(file_, texts);
    close_variables();
    return image_bytes(file_);
  }

 private:
  struct Row {
    std::string name;
    H5Id variable;
    std::size_t length;
    hid_t type;
  };

  H5Id make_axis(const VariableAbout& about, hid_t type, std::size_t length) {
    const hsize_t lengths = length;
    return make_variable(file_, about, type, space_of({&lengths, 1}),
                         creation_properties(H5P_DATASET_CREATE), {});
  }

  H5Id make_device_variable(const VariableAbout& about, hid_t type) {
    const hsize_t length = head_.devices;
    const std::array<const H5Id*, 1> axes = {&axes_[0]};
    return make_variable(file_, about, type, space_of({&length, 1}),
                         creation_properties(H5P_DATASET_CREATE), axes);
  }

  void make_flags() {
    flags_.push_back(make_device_variable(part_about(), H5T_STD_U8LE));
    write_part_flags(flags_.back());
    flags_.push_back(make_device_variable(device_status_about(), H5T_STD_U8LE));
    write_device_status_flags(flags_.back());
  }

  Row make_row(const VariableAbout& about, hid_t type, bool slow,
               const void* fill) {
    const H5Id& time = axes_[slow && head_.slow_step > 1 ? 2 : 1];
    const std::size_t length = slow ? slow_length(head_) : head_.time.size();
    const std::array<hsize_t, 2> lengths = {head_.devices, length};
    const std::array<const H5Id*, 2> axes = {&axes_[0], &time};
    const H5Id properties = row_properties(head_.compress, length);
    check_hdf5(H5Pset_fill_value(properties, type, fill),
               "choose a fill value");
    return {
        about.name,
        make_variable(file_, about, type, space_of(lengths), properties, axes),
        length, type};
  }

  // In the order of encode(), status first.
  void make_rows() {
    constexpr std::uint8_t kOff = kUnpowered;
    rows_.push_back(make_row(status_about(), H5T_STD_U8LE, false, &kOff));
    write_status_bits(rows_.back().variable);
    for (const SetVariable& about : head_.variables) {
      rows_.push_back(make_row(
          {about.name, about.units, about.long_name, about.role, about.comment},
          file_type(about.storage), about.slow, fill_values(about, 1).data()));
      write_scaling(rows_.back().variable, about);
    }
  }

  void write_row(const Row& row, const std::vector<PackedChunk>& chunks,
                 std::size_t position) {
    if (!head_.compress) {
      write_plain_row(row, chunks.front(), position);
      return;
    }
    std::array<hsize_t, 2> place = {position, 0};
    for (const PackedChunk& chunk : chunks) {
      check_hdf5(
          H5Dwrite_chunk(row.variable, H5P_DEFAULT, chunk.skipped_filters,
                         place.data(), chunk.bytes.size(), chunk.bytes.data()),
          "write " + row.name);
      place[1] += chunk_length(row.length);
    }
  }

  void write_plain_row(const Row& row, const PackedChunk& chunk,
                       std::size_t position) {
    const std::array<hsize_t, 2> start = {position, 0};
    const std::array<hsize_t, 2> count = {1, row.length};
    const H5Id file_space(H5Dget_space(row.variable), H5Sclose,
                          "write " + row.name);
    check_hdf5(H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(),
                                   nullptr, count.data(), nullptr),
               "write " + row.name);
    check_hdf5(H5Dwrite(row.variable, row.type, space_of(count), file_space,
                        H5P_DEFAULT, chunk.bytes.data()),
               "write " + row.name);
  }

  void write_axes() {
    std::vector<std::int64_t> devices(head_.devices);
    std::iota(devices.begin(), devices.end(), std::int64_t{head_.first_device});
    write_all(axes_[0], "device", H5T_STD_I64LE, devices.data());
    write_all(axes_[1], "time", H5T_IEEE_F64LE, head_.time.data());
    if (head_.slow_step == 1) return;
    const std::vector<double> slow = slow_times(head_);
    write_all(axes_[2], "truth_time", H5T_IEEE_F64LE, slow.data());
  }

  void write_device_variables(const std::vector<DeviceRow>& rows) {
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      std::vector<double> values;
      for (const DeviceRow& row : rows) values.push_back(row.parameters[p]);
      write_all(parameters_[p], head_.parameters[p].name, H5T_IEEE_F64LE,
                values.data());
    }
    std::vector<std::uint8_t> parts, statuses;
    for (const DeviceRow& row : rows) {
      parts.push_back(row.part);
      statuses.push_back(row.device_status);
    }
    write_all(flags_[0], "part", H5T_STD_U8LE, parts.data());
    write_all(flags_[1], "device_status", H5T_STD_U8LE, statuses.data());
  }

  void close_variables() {
    for (Row& row : rows_) row.variable.close("write " + row.name);
    for (std::vector<H5Id>* some : {&parameters_, &flags_, &axes_}) {
      for (H5Id& variable : *some) variable.close("write variables");
      some->clear();
    }
    rows_.clear();
  }

  const ShardHead& head_;
  H5Id file_;
  std::vector<H5Id> axes_;  // device, time and, if there is one, truth_time
  std::vector<H5Id> parameters_, flags_;
  std::vector<Row> rows_;
};

ShardBuilder::ShardBuilder(ShardHead head) : head_(std::move(head)) {
  const std::string defect = shard_head_defect(head_);
  if (!defect.empty()) throw std::runtime_error(defect);
  const QuietHdf5 quiet;
  image_ = std::make_unique<Image>(head_);
}

ShardBuilder::~ShardBuilder() {
  const QuietHdf5 quiet;
  image_.reset();
}

EncodedDevice ShardBuilder::encode(std::uint32_t position, const DeviceRow& row,
                                   const Recording* recording) const {
  return encode_device(head_, position, row, recording);
}

void ShardBuilder::add(const DeviceRow& row, const Recording* recording) {
  add(encode(static_cast<std::uint32_t>(rows_.size()), row, recording));
}

void ShardBuilder::add(const EncodedDevice& device) {
  if (rows_.size() == head_.devices)
    throw std::runtime_error(
        fmt::format("more devices than {}", head_.devices));
  const QuietHdf5 quiet;
  image_->add(device, rows_.size());
  rows_.push_back(device.row);
}

std::span<const std::byte> ShardBuilder::finish() {
  if (rows_.size() != head_.devices)
    throw std::runtime_error(
        fmt::format("{} devices; expected {}", rows_.size(), head_.devices));
  const QuietHdf5 quiet;
  return image_->finish(rows_);
}

}  // namespace beamgyro::internal
