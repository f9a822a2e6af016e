// SPDX-License-Identifier: MIT
// A CSV file of numbers, read as a profile of the temperature and of the rate.
#include "config/document.h"
#include "dataset/log/csv_file.h"
#include "sim/scenario/scenario_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  const std::string_view text = text_of(data, size);
  accept_or_reject([&] { static_cast<void>(parse_csv(text, "fuzz.csv")); });
  const std::filesystem::path file = scratch_file("fuzz.csv", text);
  for (const char* section : {"[ambient]\n", "[rate]\n"}) {
    accept_or_reject([&] {
      static_cast<void>(read_scenario(ConfigDocument::parse(
          std::string("name = \"p\"\ndevice = \"devices/nominal.toml\"\n"
                      "fidelity = \"quasistatic\"\nduration_s = 60\n"
                      "output_rate_Hz = 1\nseed = 1\n") +
              section + "file = \"fuzz.csv\"\n",
          (scratch_folder() / "fuzz.toml").string())));
    });
  }
  return 0;
}
