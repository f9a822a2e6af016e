// SPDX-License-Identifier: MIT
#include "tests/fuzz/mended_hdf5.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

namespace beamgyro::internal {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kSumBytes = 4, kSignatureBytes = 4;
constexpr std::array<std::string_view, 9> kSignatures = {
    "OHDR", "OCHK", "FRHP", "FHIB", "BTHD", "BTIN", "BTLF", "FSHD", "SMTB"};
constexpr std::string_view kDirectBlock = "FHDB";  // its sum stands inside

std::uint32_t number_at(Bytes bytes, std::size_t place) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + place, sizeof number);
  return number;
}

/// Bob Jenkins' lookup3, hashlittle() with an initial value of 0, as HDF5 sums
/// its metadata.
std::uint32_t lookup3(Bytes bytes) {
  std::uint32_t a = 0xdeadbeefu + static_cast<std::uint32_t>(bytes.size());
  std::uint32_t b = a, c = a;
  if (bytes.empty()) return c;
  for (; bytes.size() > 12; bytes = bytes.subspan(12)) {
    a += number_at(bytes, 0);
    b += number_at(bytes, 4);
    c += number_at(bytes, 8);
    a = (a - c) ^ std::rotl(c, 4), c += b;
    b = (b - a) ^ std::rotl(a, 6), a += c;
    c = (c - b) ^ std::rotl(b, 8), b += a;
    a = (a - c) ^ std::rotl(c, 16), c += b;
    b = (b - a) ^ std::rotl(a, 19), a += c;
    c = (c - b) ^ std::rotl(b, 4), b += a;
  }
  std::array<std::uint8_t, 12> rest{};
  std::ranges::copy(bytes, rest.begin());
  a += number_at(rest, 0);
  b += number_at(rest, 4);
  c += number_at(rest, 8);
  c = (c ^ b) - std::rotl(b, 14);
  a = (a ^ c) - std::rotl(c, 11);
  b = (b ^ a) - std::rotl(a, 25);
  c = (c ^ b) - std::rotl(b, 16);
  a = (a ^ c) - std::rotl(c, 4);
  b = (b ^ a) - std::rotl(a, 14);
  return (c ^ b) - std::rotl(b, 24);
}

bool is_inside(const MetadataSum& sum) { return sum.place < sum.end; }

std::uint32_t right_sum(Bytes file, const MetadataSum& sum) {
  const Bytes block = file.subspan(sum.begin, sum.end - sum.begin);
  if (!is_inside(sum)) return lookup3(block);
  std::vector<std::uint8_t> without(block.begin(), block.end());
  std::fill_n(without.begin() + static_cast<long>(sum.place - sum.begin),
              kSumBytes, std::uint8_t{0});
  return lookup3(without);
}

bool is_right(Bytes file, const MetadataSum& sum) {
  return right_sum(file, sum) == number_at(file, sum.place);
}

std::optional<MetadataSum> sum_behind(Bytes file, std::size_t begin) {
  constexpr std::size_t kLongest = 8192;
  const std::size_t last = std::min(begin + kLongest, file.size() - kSumBytes);
  for (std::size_t end = begin + kSignatureBytes; end <= last; ++end)
    if (const MetadataSum sum{begin, end, end}; is_right(file, sum)) return sum;
  return std::nullopt;
}

std::optional<MetadataSum> sum_in_direct_block(Bytes file, std::size_t begin) {
  // After signature, version, an address and an offset of 1 to 8 bytes.
  constexpr std::size_t kFirst = 14, kLast = 21, kLeast = 64, kMost = 1 << 16;
  for (std::size_t size = kLeast; size <= kMost; size *= 2)
    for (std::size_t place = kFirst; place <= kLast; ++place)
      if (const MetadataSum sum{begin, begin + size, begin + place};
          sum.end <= file.size() && is_right(file, sum))
        return sum;
  return std::nullopt;
}

}  // namespace

std::vector<MetadataSum> metadata_sums(Bytes file) {
  std::vector<MetadataSum> sums;
  for (std::size_t place = 0; place + 2 * kSumBytes < file.size(); ++place) {
    const std::string_view here(
        reinterpret_cast<const char*>(file.data()) + place, kSignatureBytes);
    std::optional<MetadataSum> sum;
    if (here == kDirectBlock)
      sum = sum_in_direct_block(file, place);
    else if (std::ranges::count(kSignatures, here) > 0)
      sum = sum_behind(file, place);
    if (sum) sums.push_back(*sum);
  }
  return sums;
}

void mend_metadata(std::span<std::uint8_t> file,
                   std::span<const MetadataSum> sums) {
  for (const MetadataSum& sum : sums) {
    const std::uint32_t right = right_sum(file, sum);
    std::memcpy(file.data() + sum.place, &right, sizeof right);
  }
}

void apply_patches(std::span<std::uint8_t> file, Bytes patches) {
  constexpr std::size_t kPlaceBytes = 4, kMostBytes = 8;
  while (patches.size() > kPlaceBytes + 1) {
    const std::size_t place = number_at(patches, 0) % file.size();
    std::size_t count = patches[kPlaceBytes] % kMostBytes + 1;
    patches = patches.subspan(kPlaceBytes + 1);
    count = std::min({count, patches.size(), file.size() - place});
    std::ranges::copy(patches.first(count),
                      file.begin() + static_cast<long>(place));
    patches = patches.subspan(count);
  }
}

}  // namespace beamgyro::internal

std::size_t find_metadata_sums(const std::uint8_t* file, std::size_t size,
                               beamgyro::internal::MetadataSum* sums,
                               std::size_t room) {
  const auto found = beamgyro::internal::metadata_sums({file, size});
  std::copy_n(found.begin(), std::min(room, found.size()), sums);
  return found.size();
}

void mend_metadata_sums(std::uint8_t* file, std::size_t size,
                        const beamgyro::internal::MetadataSum* sums,
                        std::size_t count) {
  beamgyro::internal::mend_metadata({file, size}, {sums, count});
}
