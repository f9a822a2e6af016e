// SPDX-License-Identifier: MIT
#include "sim/campaign/uniform_source.h"

#include "random/random_stream.h"
#include "sim/campaign/random_purposes.h"

namespace beamgyro::internal {

std::uint32_t stream_number(std::string_view name) {
  constexpr std::uint32_t kPolynomial = 0xEDB88320;
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : name) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit)
      crc = crc >> 1 ^ ((crc & 1) != 0 ? kPolynomial : 0);
  }
  return ~crc;
}

double UniformSource::number(std::uint32_t device, std::uint32_t stream,
                             std::size_t dimension) const {
  if (sobol) return sobol->at(device, dimension);
  return RandomStream(seed, device, stream, kDeviceDrawStream).uniform();
}

}  // namespace beamgyro::internal
