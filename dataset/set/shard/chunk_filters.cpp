// SPDX-License-Identifier: MIT
#include "dataset/set/shard/chunk_filters.h"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>

namespace beamgyro::internal {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t kModulus = 65535;

/// `sum` modulo 65535; what is no zero becomes no zero, as in HDF5.
std::uint32_t folded(std::uint64_t sum) {
  if (sum == 0) return 0;
  const std::uint64_t rest = sum % kModulus;
  return static_cast<std::uint32_t>(rest == 0 ? kModulus : rest);
}

/// Swapping the bytes of a word is multiplying it by 256 modulo 65535, so sums
/// of little-endian words are swapped in the end.
std::uint32_t swapped(std::uint32_t sum) {
  return (sum & 0xff) << 8 | sum >> 8;
}

void append_sum(std::span<const std::byte> body, std::vector<std::byte>& out) {
  const std::uint32_t sum = fletcher32(body);
  out.resize(body.size() + sizeof sum);
  std::copy(body.begin(), body.end(), out.begin());
  std::memcpy(out.data() + body.size(), &sum, sizeof sum);
}

template <std::size_t kWidth>
void shuffle_all(const std::byte* values, std::size_t count, std::byte* out) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t byte = 0; byte < kWidth; ++byte)
      out[byte * count + i] = values[i * kWidth + byte];
  }
}

}  // namespace

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  // The weighted sum of one block of words fits 32 bits.
  constexpr std::size_t kBlock = 352;
  std::uint64_t sum = 0, weighted = 0;
  const std::byte* next = bytes.data();
  for (std::size_t left = bytes.size() / 2; left > 0;) {
    const std::size_t count = std::min(left, kBlock);
    std::uint32_t block = 0, block_weighted = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::uint16_t word = 0;
      std::memcpy(&word, next + 2 * i, sizeof word);
      block += word;
      block_weighted += static_cast<std::uint32_t>(count - i) * word;
    }
    weighted = (weighted + count * (sum % kModulus) + block_weighted);
    sum += block;
    next += 2 * count;
    left -= count;
  }
  if (bytes.size() % 2 != 0) {
    sum += std::to_integer<std::uint32_t>(*next);
    weighted += sum;
  }
  return swapped(folded(weighted)) << 16 | swapped(folded(sum));
}

void shuffle(std::span<const std::byte> values, std::size_t width,
             std::span<std::byte> out) {
  const std::size_t count = values.size() / width;
  switch (width) {
    case 1:
      std::copy(values.begin(), values.end(), out.begin());
      return;
    case 2:
      return shuffle_all<2>(values.data(), count, out.data());
    case 4:
      return shuffle_all<4>(values.data(), count, out.data());
    default:
      return shuffle_all<8>(values.data(), count, out.data());
  }
}

struct ChunkPacker::Deflate {
  Deflate() {
    if (compressor == nullptr) throw std::bad_alloc();
  }
  ~Deflate() { libdeflate_free_compressor(compressor); }
  Deflate(const Deflate&) = delete;
  Deflate& operator=(const Deflate&) = delete;

  libdeflate_compressor* compressor = libdeflate_alloc_compressor(1);
};

ChunkPacker::ChunkPacker() : deflate_(std::make_unique<Deflate>()) {}
ChunkPacker::~ChunkPacker() = default;

PackedChunk ChunkPacker::pack(std::span<const std::byte> values,
                              std::size_t width) {
  shuffled_.resize(values.size());
  shuffle(values, width, shuffled_);
  packed_.resize(values.size() - values.size() / 10);
  const std::size_t size = libdeflate_zlib_compress(
      deflate_->compressor, shuffled_.data(), shuffled_.size(), packed_.data(),
      packed_.size());
  PackedChunk chunk;
  if (size == 0) {  // it did not fit
    append_sum(values, chunk.bytes);
    chunk.skipped_filters = 0b011;
  } else {
    append_sum({packed_.data(), size}, chunk.bytes);
  }
  return chunk;
}

}  // namespace beamgyro::internal
