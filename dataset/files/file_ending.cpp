// SPDX-License-Identifier: MIT
#include "dataset/files/file_ending.h"

namespace beamgyro::internal {

std::string file_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& letter : ending)
    if (letter >= 'A' && letter <= 'Z') letter += 'a' - 'A';
  return ending;
}

}  // namespace beamgyro::internal
