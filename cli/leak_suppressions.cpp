// SPDX-License-Identifier: MIT
// What LeakSanitizer asks a program for: what HDF5 keeps to the end of the
// process, see keep_hdf5_open_at_exit(), is no leak.

#define BEAMGYRO_SEEN extern "C" __attribute__((visibility("default")))

BEAMGYRO_SEEN const char* __lsan_default_suppressions();   // NOLINT
BEAMGYRO_SEEN const char* __lsan_default_suppressions() {  // NOLINT
  return "leak:libhdf5\n";
}

BEAMGYRO_SEEN const char* __lsan_default_options();   // NOLINT
BEAMGYRO_SEEN const char* __lsan_default_options() {  // NOLINT
  return "print_suppressions=0";
}
