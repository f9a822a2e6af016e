// SPDX-License-Identifier: MIT
// The program that loads plug-ins for the tests, as beamgyro does for itself.
#include <cstdlib>

#include "validation/external/plugin_host.h"

int main(int argc, char** argv) {
  return beamgyro::internal::host_plugin({argv + 2, argv + argc},
                                         std::getenv("PATH"));
}
