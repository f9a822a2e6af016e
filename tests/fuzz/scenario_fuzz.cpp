// SPDX-License-Identifier: MIT
// A scenario file beside the shipped ones.
#include "sim/scenario/scenario_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  accept_or_reject([&] {
    const ConfigDocument document = ConfigDocument::parse(
        text_of(data, size), (scratch_folder() / "fuzz.toml").string());
    static_cast<void>(read_scenario(document));
    document.reject_unknown_keys();
    static_cast<void>(profile_files(document));
  });
  return 0;
}
