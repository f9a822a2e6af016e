// SPDX-License-Identifier: MIT
// A model file.
#include "compensation/training/model_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  accept_or_reject([&] {
    static_cast<void>(read_model(ConfigDocument::parse(
        text_of(data, size), (scratch_folder() / "fuzz.toml").string())));
  });
  return 0;
}
