// SPDX-License-Identifier: MIT
#include "dataset/set/shard/shard_reader.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "dataset/files/file_checksum.h"
#include "dataset/files/hdf5_signature.h"
#include "dataset/files/json_node.h"
#include "dataset/files/set_files.h"
#include "dataset/netcdf/hdf5_driver.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_read.h"
#include "dataset/netcdf/hdf5_storage.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/signals.h"
#include "dataset/recording/units.h"
#include "dataset/set/shard/shard_encoding.h"
#include "dataset/set/shard/shard_layout.h"

namespace beamgyro::internal {
namespace {

int rank_of(hid_t variable, const std::string& name) {
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  return H5Sget_simple_extent_ndims(space);
}

Storage storage_of(hid_t variable, const std::string& name) {
  const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
  for (const Storage storage : {Storage::kFloat64, Storage::kFloat32,
                                Storage::kInt16, Storage::kInt32}) {
    if (is_true(H5Tequal(type, file_type(storage)), "compare types"))
      return storage;
  }
  throw Hdf5Error(name + " has a type that no variable of a set has");
}

/// Where slow_step is not 1 the second value of truth_time is that time.
std::size_t step_between(const std::vector<double>& time,
                         const std::vector<double>& slow) {
  std::size_t step = time.size();
  if (slow.size() > 1) {
    step = static_cast<std::size_t>(
        std::lower_bound(time.begin(), time.end(), slow[1]) - time.begin());
  }
  for (std::size_t k = 0; k < slow.size(); ++k) {
    if (k * step >= time.size() || time[k * step] != slow[k])
      throw Hdf5Error("truth_time is not every n-th time");
  }
  return std::max<std::size_t>(step, 1);
}

/// Sets the reason of every failed device from its line of /meta/failures.
void read_failures(const std::string& text, const ShardHead& head,
                   std::vector<DeviceRow>& rows) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::uint32_t device = 0;
    std::string reason;
    try {
      const auto json = parse_json(line, "/meta/failures");
      const JsonNode failure(json, "/meta/failures");
      device = failure.at("device").small_integer();
      reason = failure.at("reason").text();
    } catch (const std::invalid_argument& error) {
      throw Hdf5Error(error.what());
    }
    if (device < head.first_device || device - head.first_device >= rows.size())
      throw Hdf5Error(fmt::format(
          "/meta/failures names device {}, not in the file", device));
    rows[device - head.first_device].failure = reason;
  }
  for (DeviceRow& row : rows) {
    if (row.device_status != kDeviceOk && row.failure.empty())
      row.failure = "unknown";
  }
}

}  // namespace

class ShardFile::File {
 public:
  explicit File(OpenFile bytes)
      : bytes_(std::move(bytes)),
        file_(open_hdf5_file(bytes_, kSetFiletype, "file of a set",
                             kSetFormatVersion)) {
    read_head();
    read_rows();
    check_system_calls();
  }

  const ShardHead& head() const { return head_; }
  const std::vector<DeviceRow>& rows() const { return rows_; }

  Recording read(std::uint32_t position, bool slow,
                 const std::vector<std::string>& variables) const {
    Recording recording;
    const std::size_t step = slow ? head_.slow_step : 1;
    std::vector<std::byte> status =
        row_bytes("status", H5T_STD_U8LE, 1, position, head_.time.size());
    for (std::size_t k = 0; k < head_.time.size(); k += step) {
      recording.time.push_back(head_.time[k]);
      recording.status.push_back(std::to_integer<std::uint8_t>(status[k]));
    }
    for (const SetVariable& about : head_.variables) {
      if (about.slow != slow) continue;
      if (!variables.empty() && !std::ranges::count(variables, about.name))
        continue;
      recording.columns.push_back(
          {about.name, about.units, about.long_name, about.role,
           decoded_values(about, row_bytes(about.name, file_type(about.storage),
                                           width_of(about.storage), position,
                                           recording.time.size())),
           about.comment});
    }
    recording.fidelity = head_.fidelity;
    recording.seed = head_.seed;
    recording.program_version = head_.program_version;
    recording.git_revision = head_.git_revision;
    recording.scenario_text = head_.scenario_text;
    recording.device_text = head_.device_text;
    recording.overrides_text = head_.overrides_text;
    check_system_calls();
    const std::string defect = recording_defect(recording);
    if (!defect.empty())
      throw Hdf5Error(
          fmt::format("device {}: {}", head_.first_device + position, defect));
    return recording;
  }

 private:
  void read_head() {
    head_.program_version =
        text_attribute(file_, "the file", "beamgyro_version");
    head_.git_revision = text_attribute(file_, "the file", "git_revision");
    head_.fidelity = text_attribute(file_, "the file", "fidelity");
    head_.run = text_attribute(file_, "the file", "run");
    head_.seed = integer_attribute(file_, "seed");
    head_.campaign_text = meta_text(file_, "campaign");
    head_.scenario_text = meta_text(file_, "scenario");
    head_.device_text = meta_text(file_, "device");
    head_.overrides_text = meta_text(file_, "overrides");
    head_.time =
        read_values<double>(file_, "time", H5T_FLOAT, H5T_NATIVE_DOUBLE, 0);
    const auto numbers = read_values<std::int64_t>(file_, "device", H5T_INTEGER,
                                                   H5T_NATIVE_INT64, 0);
    if (numbers.empty() || numbers.front() < 0 || numbers.back() > UINT32_MAX)
      throw Hdf5Error("device has no numbers of devices");
    head_.devices = static_cast<std::uint32_t>(numbers.size());
    head_.first_device = static_cast<std::uint32_t>(numbers.front());
    for (const std::string& name : variable_names(file_)) read_about(name);
    const std::string defect = shard_head_defect(head_);
    if (!defect.empty()) throw Hdf5Error(defect);
  }

  void read_about(const std::string& name) {
    if (name == "device" || name == "time" || name == "part" ||
        name == "device_status")
      return;
    if (name == "truth_time") {
      head_.slow_step = step_between(
          head_.time,
          read_values<double>(file_, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, 0));
      return;
    }
    const H5Id variable = open_variable(file_, name);
    if (rank_of(variable, name) == 1) {
      head_.parameters.push_back({name, text_attribute(variable, name, "units"),
                                  text_attribute(variable, name, "long_name")});
      return;
    }
    const H5Id properties(H5Dget_create_plist(variable), H5Pclose,
                          "open " + name);
    head_.compress = H5Pget_layout(properties) == H5D_CHUNKED;
    const std::vector<hsize_t> lengths = lengths_of(variable, name, 2);
    const bool slow = lengths[1] != head_.time.size();
    if (lengths[0] != head_.devices ||
        (slow && lengths[1] != slow_length(head_)))
      throw Hdf5Error(
          fmt::format("{} has {} x {} values", name, lengths[0], lengths[1]));
    if (name == "status") {
      check_type(variable, name, H5T_INTEGER, 1);
      return;
    }
    SetVariable about{name, text_attribute(variable, name, "units"),
                      text_attribute(variable, name, "long_name"),
                      role_of(text_attribute(variable, name, "role"), name),
                      storage_of(variable, name)};
    about.slow = slow;
    about.comment = comment_of(variable, name);
    const std::string_view expected = unit_of_variable(name);
    if (!expected.empty() && about.units != expected)
      throw Hdf5Error(fmt::format("{} has the unit '{}'; expected {}", name,
                                  about.units, expected));
    if (has_attribute(variable, name, "scale_factor")) {
      about.scale_factor = number_attribute(variable, name, "scale_factor");
      about.add_offset = number_attribute(variable, name, "add_offset");
    }
    head_.variables.push_back(about);
  }

  void read_rows() {
    rows_.resize(head_.devices);
    for (const DeviceVariable& about : head_.parameters) {
      const auto values = read_values<double>(file_, about.name, H5T_FLOAT,
                                              H5T_NATIVE_DOUBLE, rows_.size());
      for (std::size_t i = 0; i < rows_.size(); ++i)
        rows_[i].parameters.push_back(values[i]);
    }
    const auto parts = read_values<std::uint8_t>(
        file_, "part", H5T_INTEGER, H5T_NATIVE_UINT8, rows_.size());
    const auto statuses = read_values<std::uint8_t>(
        file_, "device_status", H5T_INTEGER, H5T_NATIVE_UINT8, rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i].part = parts[i];
      rows_[i].device_status = statuses[i];
    }
    read_failures(meta_text(file_, "failures"), head_, rows_);
  }

  std::vector<std::byte> row_bytes(const std::string& name, hid_t type,
                                   std::size_t width, std::uint32_t position,
                                   std::size_t length) const {
    const std::string action = "read " + name;
    // read_head() has looked at what it claims.
    const H5Id variable(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose,
                        action);
    check_chunks_of_row(variable, name, position);
    const H5Id there(H5Dget_space(variable), H5Sclose, action);
    const std::array<hsize_t, 2> start = {position, 0};
    const std::array<hsize_t, 2> count = {1, length};
    check_hdf5(H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr,
                                   count.data(), nullptr),
               action);
    std::vector<std::byte> bytes(length * width);
    check_hdf5(H5Dread(variable, type, space_of(count), there, H5P_DEFAULT,
                       bytes.data()),
               action);
    return bytes;
  }

  OpenFile bytes_;
  H5Id file_;
  ShardHead head_;
  std::vector<DeviceRow> rows_;
};

namespace {

[[noreturn]] void reject(const std::filesystem::path& path,
                         const std::string& why) {
  throw std::invalid_argument(fmt::format("{}: {}", path.string(), why));
}

}  // namespace

bool is_shard_file(const std::filesystem::path& path) {
  OpenFile file = open_to_read(path, "recording or a file of a set");
  try {
    if (has_checksum(file)) return false;  // as recordings alone have
    const QuietHdf5 quiet;
    return is_hdf5_file(file) &&
           is_of_filetype(open_hdf5_file(file), kSetFiletype);
  } catch (const Hdf5Error& error) {
    reject_hdf5_file(path, error);
  } catch (const std::system_error& error) {
    reject_hdf5_file(path, read_failure(error));
  }
}

ShardFile::ShardFile(const std::filesystem::path& path)
    : ShardFile(path, open_to_read(path, "file of a set")) {}

ShardFile::ShardFile(const std::filesystem::path& directory,
                     const std::string& name)
    : ShardFile(directory / name, open_set_file(directory, name, O_RDONLY)) {}

ShardFile::ShardFile(const std::filesystem::path& path, OpenFile file)
    : path_(path) {
  const QuietHdf5 quiet;
  try {
    file_ = std::make_unique<File>(std::move(file));
  } catch (const Hdf5Error& error) {
    reject_hdf5_file(path, error);
  } catch (const std::system_error& error) {
    reject_hdf5_file(path, read_failure(error));
  }
}

ShardFile::~ShardFile() {
  const QuietHdf5 quiet;
  file_.reset();
}

const ShardHead& ShardFile::head() const { return file_->head(); }

const DeviceRow& ShardFile::row(std::uint32_t position) const {
  return file_->rows().at(position);
}

Recording ShardFile::recording(
    std::uint32_t position, const std::vector<std::string>& variables) const {
  return read(position, false, variables);
}

Recording ShardFile::slow_recording(std::uint32_t position) const {
  return read(position, true, {});
}

Recording ShardFile::read(std::uint32_t position, bool slow,
                          const std::vector<std::string>& variables) const {
  const DeviceRow& about = row(position);
  if (!about.failure.empty())
    reject(path_, fmt::format("device {} has no values: {}",
                              head().first_device + position, about.failure));
  const QuietHdf5 quiet;
  try {
    return file_->read(position, slow, variables);
  } catch (const Hdf5Error& error) {
    reject_hdf5_file(path_, error);
  }
}

}  // namespace beamgyro::internal
