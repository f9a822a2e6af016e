// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beamgyro::internal {

/// A value of a JSON file together with its place, "FILE: key.key[2]", for
/// checked reading. Every error is a std::invalid_argument with that place, the
/// value met and what would be right.
class JsonNode {
 public:
  JsonNode(const nlohmann::ordered_json& value, std::string file,
           std::string path = "")
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  JsonNode at(const std::string& key) const;  // member, must be there
  bool has(const std::string& key) const;
  /// Fails for a member that is none of these, and lists them.
  void require_only(std::initializer_list<std::string_view> keys) const;
  bool is_null() const;
  std::vector<JsonNode> elements() const;         // of an array
  double number() const;                          // finite
  std::optional<double> optional_number() const;  // nothing where it is null
  long integer(long low, long high) const;
  std::uint32_t small_integer() const;  // not below 0, of 32 bits
  std::uint64_t unsigned_integer() const;
  bool flag() const;
  std::string text() const;
  std::vector<double> numbers() const;
  std::vector<std::string> texts() const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void expected(const std::string& what) const;

  const nlohmann::ordered_json* value_;
  std::string file_;
  std::string path_;  // "key.key[2]", empty for the whole file
};

/// Parses JSON; all JSON is read through this function. Throws
/// std::invalid_argument naming `file` for a text that is not JSON. A text that
/// is nested deeper than 64 or has an object of more than 1000 members is
/// refused before it is parsed, because the library copies and prints values by
/// recursion and compares all members to add one.
nlohmann::ordered_json parse_json(std::string_view text,
                                  const std::string& file);

}  // namespace beamgyro::internal
