// SPDX-License-Identifier: MIT
// A compensator file; one that is accepted is written, read and evaluated, and
// must come out the same.
#include <string>

#include "compensation/compensator/compensator_file.h"
#include "compensation/export/export_c.h"
#include "tests/dataset/sample_recording.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  static const beamgyro::Recording recording = sample_recording(20);
  accept_or_reject([&] {
    const FittedCompensator compensator =
        parse_compensator(std::string(text_of(data, size)), "fuzz.json");
    const std::string text = compensator_text(compensator);
    if (compensator_text(parse_compensator(text, "again.json")) != text)
      throw std::logic_error("another compensator after writing and reading");
    static_cast<void>(compensated_rate(compensator, recording));
    static_cast<void>(baseline_rate(compensator, recording));
    static_cast<void>(export_c(compensator, "fuzz"));
  });
  return 0;
}
