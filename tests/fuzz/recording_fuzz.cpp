// SPDX-License-Identifier: MIT
// A recording; one that is accepted has no defect.
#include "dataset/netcdf/recording_reader.h"
#include "dataset/recording/recording_defect.h"
#include "tests/fuzz/fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beamgyro::internal;
  const std::filesystem::path file =
      scratch_file("recording.h5", text_of(data, size));
  accept_or_reject([&] {
    const std::string defect = recording_defect(read_recording(file));
    if (!defect.empty()) throw std::logic_error("read: " + defect);
  });
  return 0;
}
