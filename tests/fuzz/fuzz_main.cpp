// SPDX-License-Identifier: MIT
// What libFuzzer's main() calls, in the program of one target.
#include <cstddef>
#include <cstdint>

extern "C" {
int BEAMGYRO_FUZZ_TARGET(const std::uint8_t* data, std::size_t size);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return BEAMGYRO_FUZZ_TARGET(data, size);
}
}
