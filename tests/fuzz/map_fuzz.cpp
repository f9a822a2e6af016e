// SPDX-License-Identifier: MIT
// A map of a log, read for each axis it may have.
#include "dataset/log/log_map.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  for (const char* axis : {"", "x", "z"}) {
    accept_or_reject([&] {
      static_cast<void>(read_log_map(
          ConfigDocument::parse(text_of(data, size), "fuzz.toml"), axis));
    });
  }
  return 0;
}
