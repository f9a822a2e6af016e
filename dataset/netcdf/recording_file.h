// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Writes a recording block by block, so that memory does not grow with it. The
/// bytes do not depend on how the recording is cut into blocks. The file
/// appears under its name when it is complete (AtomicFile).
/// - A name that ends in .csv makes CSV: the columns of the HDF5 file in its
///   order under a line of names, time in s, numbers in the shortest form that
///   reads back to the same bits, `nan` where unpowered.
/// - Any other name makes HDF5 in the layout of netCDF-4: /time as the
///   dimension scale of every variable, /status, one variable for each column,
///   the texts below /meta, and a checksum at the end (file_checksum.h).
class RecordingFile {
 public:
  /// Begins a file of `samples` samples. `head` is a recording with every
  /// column and text; its samples are not used. Throws std::invalid_argument
  /// for a name that cannot be written, std::runtime_error for no samples, for
  /// names or texts with a defect (head_defect()) and when writing fails.
  RecordingFile(const Recording& head, std::size_t samples,
                const std::filesystem::path& path);
  ~RecordingFile();
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  /// Adds the next samples, at least one, with the columns of the head. Throws
  /// std::runtime_error for
  /// - other columns, or more samples than were announced;
  /// - samples with a defect (samples_defect()), named with variable and
  ///   sample;
  /// - a failure of writing.
  /// After an exception the block does not count.
  void append(const Recording& block);

  /// Publishes the file. Throws std::runtime_error when samples are missing or
  /// writing fails.
  void finish();

 private:
  class Body;
  class Hdf5Body;
  class CsvBody;

  [[noreturn]] void refuse(const std::string& defect) const;
  std::string columns_defect(const Recording& block) const;

  std::filesystem::path path_;
  std::size_t samples_, written_ = 0;
  double last_time_ = 0;              // [s]
  std::vector<std::string> columns_;  // described()
  std::unique_ptr<Body> body_;
};

}  // namespace beamgyro::internal
