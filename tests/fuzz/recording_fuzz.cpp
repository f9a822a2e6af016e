// SPDX-License-Identifier: MIT
// A recording; one that is accepted has no defect.
#include "dataset/files/text_file.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "dataset/recording/recording_defect.h"
#include "tests/dataset/sample_recording.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/hdf5_seeds.h"

namespace {

using namespace beamgyro::internal;

/// Recordings of a few samples and of some hundred, which are stored in chunks,
/// without the line of their checksum.
std::vector<std::string> recordings() {
  std::vector<std::string> files;
  for (const std::size_t samples : {4u, 400u}) {
    const std::filesystem::path file = scratch_folder() / "seed.h5";
    beamgyro::write_recording(sample_recording(samples), file);
    const std::string text = read_text_file(file);
    files.push_back(text.substr(0, text.rfind("\nSHA-256")));
  }
  return files;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  static const Hdf5Seeds seeds(recordings);
  const std::filesystem::path file =
      scratch_file("recording.h5", seeds.file_of(text_of(data, size)));
  accept_or_reject([&] {
    const std::string defect = recording_defect(read_recording(file));
    if (!defect.empty()) throw std::logic_error("read: " + defect);
  });
  return 0;
}
