// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <span>

namespace beamgyro::internal {

/// The headers of the objects of one file, before HDF5 1.10 sees them. It takes
/// for granted that the parts of a message end within it, and reads what lies
/// behind where they do not.
class ObjectHeaders {
 public:
  /// Fills bytes from a place of the file, or returns false.
  using Read =
      std::function<bool(std::uint64_t place, std::span<std::byte> bytes)>;

  /// Returns whether bytes that stand at a place are anything else than a
  /// header, or a header all of whose messages are sound: those of its
  /// continuations and the links and attributes that it has in a heap included.
  /// `is_header` tells that HDF5 reads a header or a continuation.
  bool are_sound(std::uint64_t place, std::span<const std::byte> bytes,
                 bool is_header, std::uint64_t file_size, const Read& read);

 private:
  // Where continuations, and what is left of headers, begin that were looked
  // at.
  std::set<std::uint64_t> parts_;
};

}  // namespace beamgyro::internal
