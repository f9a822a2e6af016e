// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "dataset/netcdf/recording_file.h"
#include "tests/dataset/sample_recording.h"

/// write_sample SAMPLES FILE.h5|FILE.csv
int main(int argc, char** argv) {
  try {
    if (argc != 3) return 2;
    const std::string file = argv[2];
    const auto samples = std::strtoul(argv[1], nullptr, 10);
    const beamgyro::Recording recording =
        beamgyro::internal::sample_recording(samples);
    beamgyro::write_recording(recording, file);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
