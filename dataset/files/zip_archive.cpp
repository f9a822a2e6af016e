// SPDX-License-Identifier: MIT
#include "dataset/files/zip_archive.h"

#include <libdeflate.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

constexpr int kBestLevel = 12;
constexpr std::uint16_t kVersion = 20, kDeflated = 8, kStored = 0;
constexpr std::uint16_t kUtf8Names = 1 << 11;
constexpr std::uint16_t kFirstDate = 1 << 5 | 1;  // 1 January 1980

void put(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i)
    out += static_cast<char>(value >> (8 * i) & 0xff);
}
void put_two(std::string& out, std::uint64_t value) { put(out, value, 2); }
void put_four(std::string& out, std::uint64_t value) { put(out, value, 4); }

// Empty where nothing is gained.
std::string deflated(const std::string& bytes) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)>
      compressor(libdeflate_alloc_compressor(kBestLevel),
                 libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  std::string packed(bytes.size(), '\0');
  packed.resize(libdeflate_deflate_compress(compressor.get(), bytes.data(),
                                            bytes.size(), packed.data(),
                                            packed.size()));
  return packed;
}

// What the head of a file and its line in the directory share.
std::string about(const ZipEntry& entry, std::uint16_t method,
                  std::size_t packed_size) {
  std::string text;
  put_two(text, kVersion);
  put_two(text, kUtf8Names);
  put_two(text, method);
  put_two(text, 0);  // midnight
  put_two(text, kFirstDate);
  put_four(text, libdeflate_crc32(0, entry.bytes.data(), entry.bytes.size()));
  put_four(text, packed_size);
  put_four(text, entry.bytes.size());
  put_two(text, entry.name.size());
  put_two(text, 0);  // no extra field
  return text;
}

}  // namespace

std::string zip_archive(const std::vector<ZipEntry>& entries) {
  std::size_t most = 0;
  for (const ZipEntry& entry : entries)
    most += entry.bytes.size() + 2 * entry.name.size() + 128;
  if (most > std::numeric_limits<std::uint32_t>::max() ||
      entries.size() > std::numeric_limits<std::uint16_t>::max())
    throw std::invalid_argument(
        "the archive is too large; expected at most 4 GiB and 65535 files");
  std::string archive, directory;
  for (const ZipEntry& entry : entries) {
    const std::string packed = deflated(entry.bytes);
    const std::string& stored = packed.empty() ? entry.bytes : packed;
    const std::string fields =
        about(entry, packed.empty() ? kStored : kDeflated, stored.size());
    directory += "PK\1\2";
    put_two(directory, kVersion);
    directory += fields;
    put_two(directory, 0);   // no comment
    put_two(directory, 0);   // disk
    put_two(directory, 0);   // internal attributes
    put_four(directory, 0);  // external attributes
    put_four(directory, archive.size());
    directory += entry.name;
    archive += "PK\3\4";
    archive += fields;
    archive += entry.name;
    archive += stored;
  }
  std::string end = "PK\5\6";
  put_four(end, 0);  // disks
  put_two(end, entries.size());
  put_two(end, entries.size());
  put_four(end, directory.size());
  put_four(end, archive.size());
  put_two(end, 0);  // no comment
  return archive + directory + end;
}

}  // namespace beamgyro::internal
