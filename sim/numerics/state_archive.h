// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace beamgyro::internal {

/// Writes the state of objects to bytes, or reads it back: a type gives the
/// same list of members to both. The bytes are those of this machine's numbers.
class StateArchive {
 public:
  /// Appends to `bytes`, which must outlive the object.
  static StateArchive writer(std::string& bytes) { return {&bytes, {}}; }
  /// Reads from `bytes`, which must outlive the object.
  static StateArchive reader(std::string_view bytes) {
    return {nullptr, bytes};
  }

  bool is_reading() const { return written_ == nullptr; }
  /// Returns whether everything has been read.
  bool at_end() const { return left_.empty(); }
  /// What has not been read.
  std::string_view rest() const { return left_; }

  /// Takes numbers, arrays of them, and types that have archive(StateArchive&).
  /// Throws std::invalid_argument when there are too few bytes.
  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }

 private:
  StateArchive(std::string* written, std::string_view left)
      : written_(written), left_(left) {}

  template <class Value>
  void take(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      take_bytes(&value, sizeof(Value));
    } else {
      value.archive(*this);
    }
  }
  template <class Value, std::size_t kCount>
  void take(std::array<Value, kCount>& values) {
    for (Value& value : values) take(value);
  }

  void take_bytes(void* data, std::size_t size) {
    if (!is_reading()) {
      written_->append(static_cast<const char*>(data), size);
      return;
    }
    if (left_.size() < size)
      throw std::invalid_argument("the bytes of the state end too early");
    std::memcpy(data, left_.data(), size);
    left_.remove_prefix(size);
  }

  std::string* written_;  // null: reading
  std::string_view left_;
};

}  // namespace beamgyro::internal
