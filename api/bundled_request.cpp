// SPDX-License-Identifier: MIT
#include "api/bundled_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "api/program_version.h"
#include "api/validation_members.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;
using RequestValue = nlohmann::ordered_json;

constexpr std::uint32_t kMostDevices = 4'000'000'000;

// The value of a member as a bundle stores it: names of inputs for files.
RequestValue stored_value(const ValidationMember& row,
                          const ValidationOptions& options,
                          const InputNames& names) {
  const std::string group(row.bundle_key);
  const auto name_of = [&](const fs::path& path) {
    return RequestValue(names.at({group, path}));
  };
  return std::visit(
      [&](auto member) -> RequestValue {
        const auto& value = options.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::vector<fs::path>>) {
          RequestValue list = RequestValue::array();
          for (const fs::path& path : value) list.push_back(name_of(path));
          return list;
        } else if constexpr (requires { value.has_value(); }) {
          if (!value) return nullptr;
          if constexpr (std::is_same_v<Value, std::optional<fs::path>>)
            return name_of(*value);
          else if constexpr (std::is_same_v<Value, std::optional<Device>>)
            return name_of(value->name());
          else if constexpr (std::is_same_v<Value, std::optional<Set>>)
            throw std::logic_error("a set is in no bundle");
          else
            return *value;
        } else if constexpr (std::is_same_v<Value, std::vector<OwnMetric>>) {
          throw std::logic_error("a function is in no bundle");
        } else {
          return value;
        }
      },
      row.member);
}

fs::path listed_path(const Bundle& bundle, const JsonNode& node) {
  return bundle.directory / listed_name(bundle, node);
}

void read_value(const ValidationMember& row, const Bundle& bundle,
                const JsonNode& node, ValidationOptions& options) {
  std::visit(
      [&](auto member) {
        auto& value = options.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::vector<fs::path>>) {
          for (const JsonNode& one : node.elements())
            value.push_back(listed_path(bundle, one));
        } else if (node.is_null()) {
          return;
        } else if constexpr (std::is_same_v<Value, std::optional<fs::path>>) {
          value = listed_path(bundle, node);
        } else if constexpr (std::is_same_v<Value, std::optional<Device>>) {
          value = Device::read(listed_path(bundle, node));
        } else if constexpr (std::is_same_v<Value, bool>) {
          value = node.flag();
        } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
          value = node.number();
          if (!(*value > 0)) node.fail("expected a number above 0");
        } else if constexpr (std::is_same_v<Value,
                                            std::optional<std::uint32_t>>) {
          value = static_cast<std::uint32_t>(node.integer(1, kMostDevices));
        } else if constexpr (std::is_same_v<Value,
                                            std::optional<std::uint64_t>>) {
          value = node.unsigned_integer();
        } else {
          node.fail("expected none, in a bundle");
        }
      },
      row.member);
}

}  // namespace

nlohmann::ordered_json request_json(const Validator& validator,
                                    const InputNames& names) {
  const CompensatorSource& source = validator.source();
  RequestValue json{
      {"compensator", source.files.empty()
                          ? source.argument
                          : names.at({"compensator", source.argument})}};
  for (const ValidationMember& row : validation_members())
    if (!row.bundle_key.empty())
      json[std::string(row.bundle_key)] =
          stored_value(row, validator.options(), names);
  return json;
}

BundledRequest request_of(const Bundle& bundle) {
  const JsonNode node(bundle.request, (bundle.directory / kBundleFile).string(),
                      "request");
  BundledRequest request;
  const JsonNode compensator = node.at("compensator");
  request.compensator = compensator.text();
  if (source_kind(request.compensator) != SourceKind::kCommand)
    request.compensator = listed_path(bundle, compensator).string();
  std::vector<std::string> known{"compensator"};
  for (const ValidationMember& row : validation_members()) {
    if (row.bundle_key.empty()) continue;
    known.emplace_back(row.bundle_key);
    // An older program did not have every member.
    if (node.has(known.back()))
      read_value(row, bundle, node.at(known.back()), request.options);
  }
  for (const auto& [key, value] : bundle.request.items())
    if (std::ranges::count(known, key) == 0)
      node.fail(fmt::format("\"{}\": unknown key", key));
  try {
    require_sound(request.options);
  } catch (const std::invalid_argument& error) {
    node.fail(error.what());
  }
  return request;
}

BundleContent bundle_content(const Validator& validator) {
  return {validator.inputs(),
          [&validator](const InputNames& names) {
            return request_json(validator, names);
          },
          kProgramVersion, kGitRevision};
}

}  // namespace beamgyro::internal
