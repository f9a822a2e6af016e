// SPDX-License-Identifier: MIT
// A map, "=====", and the log that it describes.
#include "dataset/log/log_import.h"
#include "dataset/recording/recording_defect.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  const auto [map, log] = split(text_of(data, size));
  accept_or_reject([&, map = map, log = log] {
    const ImportedLog imported =
        import_log(log, "fuzz.csv",
                   read_log_map(ConfigDocument::parse(map, "map.toml"), ""));
    const std::string defect = recording_defect(imported.recording);
    if (!defect.empty()) throw std::logic_error("imported: " + defect);
  });
  return 0;
}
