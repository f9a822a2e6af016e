// SPDX-License-Identifier: MIT
// A device file; a device that is accepted is also solved at 25 degC.
#include "sim/device/device_file.h"
#include "sim/dynamics/gyro.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  accept_or_reject([&] {
    const ConfigDocument document =
        ConfigDocument::parse(text_of(data, size), "fuzz.toml");
    const DeviceParameters device = read_device(document);
    document.reject_unknown_keys();
    try {
      static_cast<void>(drive_heating(make_gyro(device)));
    } catch (const std::runtime_error&) {
      // The loop cannot lock, or the device cannot be built.
    }
  });
  return 0;
}
