// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dataset/recording.h"

namespace beamgyro {

/// A recording written block by block, so that memory does not grow with it:
/// CSV under a name that ends in .csv, else HDF5. CSV holds the columns of the
/// HDF5 file, in its order, under a line of names; time in s, numbers in the
/// shortest form that reads back to the same bits, `nan` where unpowered.
/// HDF5 is made for netCDF-4 tools, too: /time as the dimension scale of every
/// variable, /status, one variable per column, the texts below /meta, and ends
/// with a checksum (file_checksum.h). The bytes do not depend on how the
/// recording is cut into blocks. The file appears under its name when it is
/// complete (AtomicFile).
class RecordingFile {
 public:
  /// A file of `samples` samples. `head` is a recording with every column and
  /// text; its samples are not used. Throws std::invalid_argument for a name
  /// that cannot be written, std::runtime_error for no samples, for names or
  /// texts with a defect (head_defect()) and when writing fails.
  RecordingFile(const Recording& head, std::size_t samples,
                const std::filesystem::path& path);
  ~RecordingFile();
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  /// The next samples, one at least, in the columns of the head. Throws
  /// std::runtime_error for other columns, for samples with a defect
  /// (samples_defect()), named with variable and sample, for more than were
  /// announced and when writing fails; the block does not count then.
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

/// The whole of a recording at once.
void write_recording(const Recording& recording,
                     const std::filesystem::path& path);

}  // namespace beamgyro
