// SPDX-License-Identifier: MIT
#include "compensation/json_node.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace beamgyro {

void JsonNode::fail(const std::string& message) const {
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

bool JsonNode::is_null() const { return value_->is_null(); }

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_->is_array()) expected("an array");
  std::vector<JsonNode> nodes;
  for (std::size_t k = 0; k < value_->size(); ++k)
    nodes.emplace_back((*value_)[k], file_, fmt::format("{}[{}]", path_, k));
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

std::uint64_t JsonNode::unsigned_integer() const {
  if (!value_->is_number_unsigned()) expected("an integer not below 0");
  return value_->get<std::uint64_t>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) expected("a text");
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers() const {
  std::vector<double> result;
  for (const JsonNode& element : elements()) result.push_back(element.number());
  return result;
}

std::vector<std::string> JsonNode::texts() const {
  std::vector<std::string> result;
  for (const JsonNode& element : elements()) result.push_back(element.text());
  return result;
}

}  // namespace beamgyro
