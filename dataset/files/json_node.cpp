// SPDX-License-Identifier: MIT
#include "dataset/files/json_node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "config/cut_text.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kLongestMessage = 2000;  // bytes

}  // namespace

void JsonNode::fail(const std::string& text) const {
  const std::string_view message = cut_text(text, kLongestMessage);
  throw std::invalid_argument(
      path_.empty() ? fmt::format("{}: {}", file_, message)
                    : fmt::format("{}: {}: {}", file_, path_, message));
}

void JsonNode::expected(const std::string& what) const {
  std::string met =
      value_->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (met.size() > 40) met = met.substr(0, 40) + "...";
  fail(fmt::format("{}, must be {}", met, what));
}

JsonNode JsonNode::at(const std::string& key) const {
  if (!value_->is_object()) expected("an object");
  const auto member = value_->find(key);
  if (member == value_->end()) fail(fmt::format("\"{}\" is missing", key));
  return {*member, file_, path_.empty() ? key : path_ + "." + key};
}

bool JsonNode::has(const std::string& key) const {
  return value_->is_object() && value_->contains(key);
}

void JsonNode::require_only(
    std::initializer_list<std::string_view> keys) const {
  if (!value_->is_object()) expected("an object");
  for (const auto& member : value_->items())
    if (std::ranges::find(keys, member.key()) == keys.end())
      fail(fmt::format("\"{}\" is not known here; known are {}",
                       member.key().substr(0, 40), fmt::join(keys, ", ")));
}

bool JsonNode::is_null() const { return value_->is_null(); }

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_->is_array()) expected("an array");
  std::vector<JsonNode> nodes;
  for (std::size_t k = 0; k < value_->size(); ++k)
    nodes.push_back({(*value_)[k], file_, fmt::format("{}[{}]", path_, k)});
  return nodes;
}

double JsonNode::number() const {
  if (!value_->is_number() || !std::isfinite(value_->get<double>()))
    expected("a finite number");
  return value_->get<double>();
}

std::optional<double> JsonNode::optional_number() const {
  if (value_->is_null()) return std::nullopt;
  return number();
}

long JsonNode::integer(long low, long high) const {
  if (!value_->is_number_integer() || value_->get<double>() < double(low) ||
      value_->get<double>() > double(high))
    expected(fmt::format("an integer in [{}, {}]", low, high));
  return value_->get<long>();
}

std::uint32_t JsonNode::small_integer() const {
  return static_cast<std::uint32_t>(
      integer(0, std::numeric_limits<std::uint32_t>::max()));
}

std::uint64_t JsonNode::unsigned_integer() const {
  if (!value_->is_number_unsigned()) expected("an integer not below 0");
  return value_->get<std::uint64_t>();
}

bool JsonNode::flag() const {
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) expected("a text");
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers() const {
  std::vector<double> result;
  for (const JsonNode& node : elements()) result.push_back(node.number());
  return result;
}

std::vector<std::string> JsonNode::texts() const {
  std::vector<std::string> result;
  for (const JsonNode& node : elements()) result.push_back(node.text());
  return result;
}

namespace {

/// Throws when the nesting is too deep or an object has too many members, up to
/// the first error that the parser would find.
void check_extent(std::string_view text, const std::string& file) {
  constexpr std::size_t kDeepest = 64, kMostMembers = 1000;
  const auto fail = [&](const std::string& message) {
    throw std::invalid_argument(fmt::format("{}: {}", file, message));
  };
  std::vector<std::size_t> colons;  // in each bracket that is open
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text) {
      if (c == '\\') ++i;
      in_text = c != '"';
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      colons.push_back(0);
      if (colons.size() > kDeepest)
        fail(
            fmt::format("arrays and objects nest deeper than {}; expected at "
                        "most that",
                        kDeepest));
    } else if ((c == ']' || c == '}') && !colons.empty()) {
      colons.pop_back();
    } else if (c == ':' && !colons.empty() && ++colons.back() > kMostMembers) {
      fail(fmt::format("an object of more than {} members; expected fewer",
                       kMostMembers));
    }
  }
}

}  // namespace

nlohmann::ordered_json parse_json(std::string_view text,
                                  const std::string& file) {
  check_extent(text, file);
  try {
    return nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    const std::string what =
        error.what();  // "[json...] at line L, column C:.."
    throw std::invalid_argument(
        fmt::format("{}: not a whole JSON file: {}", file,
                    cut_text(std::string_view(what).substr(what.find("] ") + 2),
                             kLongestMessage)));
  }
}

}  // namespace beamgyro::internal
