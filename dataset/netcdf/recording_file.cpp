// SPDX-License-Identifier: MIT
#include "dataset/netcdf/recording_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/file_checksum.h"
#include "dataset/files/file_ending.h"
#include "dataset/netcdf/hdf5_driver.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_write.h"
#include "dataset/netcdf/recording_reader.h"
#include "dataset/recording/recording_defect.h"

namespace beamgyro {
namespace internal {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

void append_number(double value, std::string& text) {
  if (value != value) {  // the sign of a NaN means nothing
    text += "nan";
    return;
  }
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

// Returns the properties of a column that must be the same in every block.
std::string described(const Column& column) {
  return fmt::format("{} [{}], {}", column.name, column.units,
                     role_name(column.role));
}

/// Positions in a file [bytes] at which the values of each variable begin:
/// little-endian doubles, and the bytes of the status.
struct Hdf5Layout {
  std::uint64_t time = 0, status = 0;
  std::vector<std::uint64_t> columns;
};

/// Makes variables over one time axis, contiguous and without their values:
/// deflate would be the slowest part of a run by far.
class VariableMaker {
 public:
  VariableMaker(hid_t file, hsize_t length)
      : file_(file),
        space_(space_of({&length, 1})),
        properties_(creation_properties(H5P_DATASET_CREATE)) {
    check_hdf5(H5Pset_alloc_time(properties_, H5D_ALLOC_TIME_EARLY),
               "place values");
    check_hdf5(H5Pset_fill_time(properties_, H5D_FILL_TIME_NEVER),
               "leave values open");
  }

  /// Without `time` the variable becomes the time axis itself.
  H5Id make(const VariableAbout& about, hid_t type, const H5Id* time) const {
    const std::span<const H5Id* const> axes(&time, time == nullptr ? 0 : 1);
    return make_variable(file_, about, type, space_, properties_, axes);
  }

 private:
  hid_t file_;
  H5Id space_, properties_;
};

std::uint64_t place_of(const H5Id& variable, const std::string& name) {
  const haddr_t place = H5Dget_offset(variable);
  check_hdf5(place == HADDR_UNDEF ? -1 : 0, "place " + name);
  return place;
}

H5Id make_status(const VariableMaker& maker, const H5Id& time) {
  H5Id status = maker.make(status_about(), H5T_STD_U8LE, &time);
  write_status_bits(status);
  return status;
}

Hdf5Layout make_variables(hid_t file, const Recording& head,
                          std::size_t samples) {
  const VariableMaker maker(file, samples);
  H5Id time = maker.make({"time", "s", "time"}, H5T_IEEE_F64LE, nullptr);
  Hdf5Layout layout;
  layout.time = place_of(time, "time");
  const std::size_t status_at = status_position(head);
  for (std::size_t i = 0; i <= head.columns.size(); ++i) {
    if (i == status_at) {
      H5Id status = make_status(maker, time);
      layout.status = place_of(status, "status");
      status.close("write status");
    }
    if (i == head.columns.size()) break;
    const Column& column = head.columns[i];
    H5Id variable = maker.make({column.name, column.units, column.long_name,
                                column.role, column.comment},
                               H5T_IEEE_F64LE, &time);
    layout.columns.push_back(place_of(variable, column.name));
    variable.close("write " + column.name);
  }
  time.close("write time");
  return layout;
}

/// Makes `bytes` an HDF5 file for `samples` samples that is complete except for
/// the values. The caller writes these without the library, because HDF5 1.10
/// is unreliable after one of its own writes has failed (a full disk). Throws
/// Hdf5Error.
Hdf5Layout make_hdf5_file(const Recording& head, std::size_t samples,
                          OpenFile& bytes) {
  const QuietHdf5 quiet;
  H5Id file = create_hdf5_file(bytes);
  write_origin(file, kRecordingFiletype, kRecordingFormatVersion, head);
  const std::array<NamedText, 4> about = {
      {{"title", head.title},
       {"history", head.history},
       {"compensator", head.compensator},
       {"compensator_sha256", head.compensator_sha256}}};
  for (const NamedText& text : about)
    if (!text.text.empty()) write_text(file, text.name, text.text);
  Hdf5Layout layout = make_variables(file, head, samples);
  const std::array<NamedText, 3> texts = {{{"scenario", head.scenario_text},
                                           {"device", head.device_text},
                                           {"overrides", head.overrides_text}}};
  write_meta(file, texts);
  file.close("close the file");
  check_system_calls();
  return layout;
}

}  // namespace

// The file under its partial name, and how samples get into it.
class RecordingFile::Body {
 public:
  explicit Body(const fs::path& path) : path_(path), target_(path) {}
  virtual ~Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  // `first`: the number of samples before this block.
  virtual void append(const Recording& block, std::size_t first) = 0;

  void publish() {
    try {
      complete(target_.file());
    } catch (const std::system_error& error) {
      throw_file_error(path_, "cannot write", error.code());
    }
    target_.publish();
  }

 protected:
  /// Writes what follows the values at the end of the file.
  virtual void complete(OpenFile&) {}

  OpenFile& file() { return target_.file(); }

  void write_at(std::uint64_t place, const void* bytes, std::size_t size) {
    try {
      target_.file().write_at(place,
                              {static_cast<const std::byte*>(bytes), size});
    } catch (const std::system_error& error) {
      throw_file_error(path_, "cannot write", error.code());
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error(fmt::format("{}: {}", path_.string(), reason));
  }

 private:
  fs::path path_;
  AtomicFile target_;
};

class RecordingFile::Hdf5Body : public Body {
 public:
  Hdf5Body(const Recording& head, std::size_t samples, const fs::path& path)
      : Body(path) {
    try {
      layout_ = make_hdf5_file(head, samples, file());
    } catch (const Hdf5Error& error) {
      fail(error.what());
    }
  }

  void append(const Recording& block, std::size_t first) override {
    const auto write = [&](std::uint64_t place,
                           const std::vector<double>& values) {
      write_at(place + first * sizeof(double), values.data(),
               values.size() * sizeof(double));
    };
    write(layout_.time, block.time);
    write_at(layout_.status + first, block.status.data(), block.status.size());
    for (std::size_t i = 0; i < block.columns.size(); ++i)
      write(layout_.columns[i], block.columns[i].values);
  }

 private:
  void complete(OpenFile& file) override { append_checksum(file); }

  Hdf5Layout layout_;
};

class RecordingFile::CsvBody : public Body {
 public:
  CsvBody(const Recording& head, const fs::path& path)
      : Body(path), status_at_(status_position(head)) {
    std::string text = "time";
    for (std::size_t i = 0; i <= head.columns.size(); ++i) {
      if (i == status_at_) text += ",status";
      if (i < head.columns.size()) text += ',' + head.columns[i].name;
    }
    text += '\n';
    write_at(0, text.data(), text.size());
    size_ = text.size();
  }

  void append(const Recording& block, std::size_t) override {
    constexpr std::size_t kPiece = std::size_t{1} << 16;  // [bytes]
    std::uint64_t place = size_;
    std::string text;
    const auto flush = [&] {
      write_at(place, text.data(), text.size());
      place += text.size();
      text.clear();
    };
    for (std::size_t k = 0; k < block.time.size(); ++k) {
      append_number(block.time[k], text);
      for (std::size_t i = 0; i <= block.columns.size(); ++i) {
        if (i == status_at_) text += ',' + std::to_string(block.status[k]);
        if (i == block.columns.size()) break;
        text += ',';
        append_number(block.columns[i].values[k], text);
      }
      text += '\n';
      if (text.size() > kPiece) flush();
    }
    flush();
    size_ = place;
  }

 private:
  std::size_t status_at_;
  std::uint64_t size_ = 0;  // of the blocks that are written [bytes]
};

RecordingFile::RecordingFile(const Recording& head, std::size_t samples,
                             const fs::path& path)
    : path_(path), samples_(samples) {
  std::string defect = head_defect(head);
  if (defect.empty() && samples == 0)
    defect = "time: no samples; expected at least one";
  if (!defect.empty()) refuse(defect);
  for (const Column& column : head.columns)
    columns_.push_back(described(column));
  if (file_ending(path) == ".csv") {
    body_ = std::make_unique<CsvBody>(head, path);
  } else {
    body_ = std::make_unique<Hdf5Body>(head, samples, path);
  }
}

RecordingFile::~RecordingFile() = default;

void RecordingFile::refuse(const std::string& defect) const {
  throw std::runtime_error(
      fmt::format("{}: not written: {}", path_.string(), defect));
}

std::string RecordingFile::columns_defect(const Recording& block) const {
  if (block.columns.size() != columns_.size())
    return fmt::format("{} columns; expected {}", block.columns.size(),
                       columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::string met = described(block.columns[i]);
    if (met != columns_[i])
      return fmt::format("column {} is {}; expected {}", i, met, columns_[i]);
  }
  return {};
}

void RecordingFile::append(const Recording& block) {
  std::string defect = columns_defect(block);
  if (defect.empty()) defect = samples_defect(block, written_);
  if (defect.empty() && written_ > 0 && !(block.time.front() > last_time_)) {
    defect = fmt::format("time: sample {} is {} s, not after {} s before it",
                         written_, block.time.front(), last_time_);
  }
  if (defect.empty() && written_ + block.time.size() > samples_) {
    defect = fmt::format("{} samples; expected {}",
                         written_ + block.time.size(), samples_);
  }
  if (!defect.empty()) refuse(defect);
  body_->append(block, written_);
  written_ += block.time.size();
  last_time_ = block.time.back();
}

void RecordingFile::finish() {
  if (written_ != samples_)
    refuse(fmt::format("{} samples; expected {}", written_, samples_));
  body_->publish();
}

}  // namespace internal

void write_recording(const Recording& recording,
                     const std::filesystem::path& path) {
  internal::RecordingFile file(recording, recording.time.size(), path);
  file.append(recording);
  file.finish();
}

}  // namespace beamgyro
