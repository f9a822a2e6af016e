// SPDX-License-Identifier: MIT
#include "dataset/set/set_view.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_write.h"
#include "dataset/set/shard/shard_encoding.h"
#include "dataset/set/shard/shard_layout.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro::internal {
namespace {

class View {
 public:
  View(const ShardHead& head, std::span<const ManifestEntry> entries)
      : head_(head), entries_(entries), file_(make_image()) {
    for (const ManifestEntry& entry : entries) {
      devices_ = std::max<hsize_t>(devices_,
                                   hsize_t{entry.first_device} + entry.devices);
    }
    write_root_attributes(file_, head);
    make_axes();
    make_device_variables();
    make_rows();
    const std::array<NamedText, 4> texts = {
        {{"campaign", head.campaign_text},
         {"scenario", head.scenario_text},
         {"device", head.device_text},
         {"overrides", head.overrides_text}}};
    write_meta(file_, texts);
    axes_.clear();
  }

  std::span<const std::byte> bytes() const { return image_bytes(file_); }

 private:
  void make_axis(const VariableAbout& about, hid_t type, hsize_t length,
                 const void* values) {
    axes_.push_back(make_variable(file_, about, type, space_of({&length, 1}),
                                  creation_properties(H5P_DATASET_CREATE), {}));
    write_all(axes_.back(), about.name, type, values);
  }

  void make_axes() {
    std::vector<std::int64_t> numbers(devices_);
    std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
    make_axis({"device", "1", "number of the device", Role::kTruth},
              H5T_STD_I64LE, devices_, numbers.data());
    make_axis({"time", "s", "time"}, H5T_IEEE_F64LE, head_.time.size(),
              head_.time.data());
    if (head_.slow_step == 1) return;
    const std::vector<double> slow = slow_times(head_);
    make_axis({"truth_time", "s", "time of slow truth"}, H5T_IEEE_F64LE,
              slow.size(), slow.data());
  }

  /// A variable over device and, unless it is 0, `length` times of `time`.
  H5Id make(const VariableAbout& about, hid_t type, const void* fill,
            hsize_t length = 0, const H5Id* time = nullptr) {
    const std::size_t rank = length == 0 ? 1 : 2;
    const H5Id properties = creation_properties(H5P_DATASET_CREATE);
    const std::string action = "write " + about.name;
    check_hdf5(H5Pset_fill_value(properties, type, fill), action);
    const std::array<hsize_t, 2> lengths = {devices_, length};
    const H5Id space = space_of(std::span(lengths).first(rank));
    for (const ManifestEntry& entry : entries_) {
      const std::array<hsize_t, 2> start = {entry.first_device, 0};
      const std::array<hsize_t, 2> count = {entry.devices, length};
      check_hdf5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(),
                                     nullptr, count.data(), nullptr),
                 action);
      check_hdf5(H5Pset_virtual(properties, space, entry.file.c_str(),
                                about.name.c_str(),
                                space_of(std::span(count).first(rank))),
                 action);
    }
    const std::array<const H5Id*, 2> axes = {&axes_[0], time};
    return make_variable(file_, about, type, space, properties,
                         std::span(axes).first(rank));
  }

  void make_device_variables() {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    for (const DeviceVariable& about : head_.parameters)
      make({about.name, about.units, about.long_name, Role::kTruth},
           H5T_IEEE_F64LE, &kNaN);
    constexpr std::uint8_t kUnknown = 255;
    write_part_flags(make(part_about(), H5T_STD_U8LE, &kUnknown));
    write_device_status_flags(
        make(device_status_about(), H5T_STD_U8LE, &kUnknown));
  }

  void make_rows() {
    constexpr std::uint8_t kOff = kUnpowered;
    const H5Id status =
        make(status_about(), H5T_STD_U8LE, &kOff, head_.time.size(), &axes_[1]);
    write_status_bits(status);
    for (const SetVariable& about : head_.variables) {
      const bool slow = about.slow && head_.slow_step > 1;
      const H5Id variable = make(
          {about.name, about.units, about.long_name, about.role, about.comment},
          file_type(about.storage), fill_values(about, 1).data(),
          slow ? slow_length(head_) : head_.time.size(), &axes_[slow ? 2 : 1]);
      write_scaling(variable, about);
    }
  }

  const ShardHead& head_;
  std::span<const ManifestEntry> entries_;
  hsize_t devices_ = 0;
  H5Id file_;
  std::vector<H5Id> axes_;
};

bool holds(const std::filesystem::path& file, const std::string& hash) {
  return std::filesystem::exists(file) && sha256_of_file(file) == hash;
}

}  // namespace

std::vector<std::byte> view_bytes(const ShardHead& head,
                                  std::span<const ManifestEntry> entries) {
  const QuietHdf5 quiet;
  const View view(head, entries);
  const std::span<const std::byte> image = view.bytes();
  return {image.begin(), image.end()};
}

ManifestView write_view(const std::filesystem::path& directory,
                        const ShardHead& head,
                        std::span<const ManifestEntry> entries) {
  const std::vector<std::byte> bytes = view_bytes(head, entries);
  const std::string name = view_name(head.run);
  publish_file(directory, name, bytes);
  return {name, bytes.size(), sha256(bytes)};
}

std::vector<FileDefect> check_views(const std::filesystem::path& directory,
                                    const Manifest& manifest,
                                    std::span<const FileDefect> known) {
  std::vector<FileDefect> defects;
  if (!manifest.head || !manifest.is_finished) return defects;
  std::set<std::string> damaged;
  for (const FileDefect& defect : known) damaged.insert(defect.file);
  const auto runs = static_cast<std::uint32_t>(manifest.head->runs.size());
  for (std::uint32_t run = 0; run < runs; ++run) {
    std::vector<ManifestEntry> entries;
    for (const ManifestEntry& entry : manifest.entries) {
      if (entry.index % runs == run) entries.push_back(entry);
    }
    if (entries.empty() ||
        std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
          return damaged.contains(entry.file);
        }))
      continue;
    const std::string name = view_name(manifest.head->runs[run]);
    const ShardFile first(directory / entries.front().file);
    const std::vector<std::byte> bytes = view_bytes(first.head(), entries);
    const ManifestView expected{name, bytes.size(), sha256(bytes)};
    if (std::find(manifest.views.begin(), manifest.views.end(), expected) ==
        manifest.views.end()) {
      defects.push_back({name, "is not the view of its files", {}});
    } else if (!damaged.contains(name) &&
               !holds(directory / name, expected.sha256)) {
      defects.push_back({name, "holds other bytes than were written", {}});
    }
  }
  return defects;
}

}  // namespace beamgyro::internal
