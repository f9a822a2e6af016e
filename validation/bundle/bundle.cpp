// SPDX-License-Identifier: MIT
#include "validation/bundle/bundle.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "config/file_error.h"
#include "dataset/files/directory.h"
#include "dataset/files/json_node.h"
#include "dataset/files/publish.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "dataset/set/source_copies.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kBundleName = "bundle.json";
constexpr const char* kBundleFiletype = "beamgyro-bundle";

// Names of copies by group and path.
using CopyNames = std::map<std::pair<std::string, fs::path>, std::string>;

// A file of a bundle.
struct BundleInput {
  std::string name;  // inputs/GROUP/...
  std::string text;
};

// Returns the copies of all inputs. Those of a group stand to each other as the
// originals do, so that the names in them stay valid.
std::vector<BundleInput> copies_of(const std::vector<InputFile>& inputs,
                                   CopyNames& names) {
  std::vector<std::string> groups;
  for (const InputFile& input : inputs)
    if (std::ranges::count(groups, input.group) == 0)
      groups.push_back(input.group);
  std::vector<BundleInput> copies;
  for (const std::string& group : groups) {
    std::vector<SourceText> texts;
    for (const InputFile& input : inputs)
      if (input.group == group)
        texts.push_back({input.path, read_text_file(input.path)});
    const std::vector<SourceEntry> entries = source_entries(texts);
    std::vector<fs::path> placed;  // of the entries: one for each file
    for (SourceText& text : texts) {
      const fs::path path = fs::absolute(text.path).lexically_normal();
      const auto known = std::ranges::find(placed, path);
      const auto k = static_cast<std::size_t>(known - placed.begin());
      const std::string& file = entries[k].file;  // source/...
      const std::string name =
          fmt::format("inputs/{}{}", group, file.substr(file.find('/')));
      names.emplace(std::pair(group, text.path), name);
      if (known != placed.end()) continue;
      placed.push_back(path);
      copies.push_back({name, std::move(text.text)});
    }
  }
  return copies;
}

void publish_text(const fs::path& directory, const std::string& name,
                  const std::string& text) {
  publish_file(directory, name, std::as_bytes(std::span(text)));
}

Json hashes_of(const auto& files) {
  Json list = Json::array();
  for (const auto& file : files)
    list.push_back({{"file", file.name}, {"sha256", sha256(file.text)}});
  return list;
}

Json request_json(const ValidationRequest& request, const CopyNames& names) {
  const auto name_of = [&](const char* group, const fs::path& path) {
    return names.at({group, path});
  };
  const auto optional_name = [&](const char* group,
                                 const std::optional<fs::path>& path) {
    return path ? Json(name_of(group, *path)) : Json();
  };
  const bool is_command = request.compensator.starts_with("cmd:");
  Json runs = Json::array();
  for (const fs::path& run : request.runs) runs.push_back(name_of("runs", run));
  return {
      {"compensator", is_command ? request.compensator
                                 : name_of("compensator", request.compensator)},
      {"device", optional_name("device", request.device)},
      {"qualification",
       request.device ? Json(name_of("qualification", request.qualification))
                      : Json()},
      {"runs", runs},
      {"full_scale_deg_per_s",
       request.full_scale ? Json(*request.full_scale) : Json()},
      {"specification", optional_name("specification", request.specification)},
      {"workbench", optional_name("workbench", request.workbench)},
      {"campaign", optional_name("campaign", request.campaign)},
      {"devices", request.devices ? Json(*request.devices) : Json()}};
}

std::optional<fs::path> optional_path(const fs::path& directory,
                                      const JsonNode& node) {
  if (node.is_null()) return {};
  return directory / node.text();
}

ValidationRequest request_from(const fs::path& directory,
                               const JsonNode& node) {
  ValidationRequest request;
  request.compensator = node.at("compensator").text();
  if (!request.compensator.starts_with("cmd:"))
    request.compensator = (directory / request.compensator).string();
  request.device = optional_path(directory, node.at("device"));
  if (request.device)
    request.qualification = directory / node.at("qualification").text();
  for (const std::string& run : node.at("runs").texts())
    request.runs.push_back(directory / run);
  request.full_scale = node.at("full_scale_deg_per_s").optional_number();
  request.specification = optional_path(directory, node.at("specification"));
  request.workbench = optional_path(directory, node.at("workbench"));
  request.campaign = optional_path(directory, node.at("campaign"));
  if (const JsonNode devices = node.at("devices"); !devices.is_null())
    request.devices = devices.integer(1, 4'000'000'000);
  return request;
}

bool has_bytes(const fs::path& directory, const std::string& name,
               const std::string& digits) {
  try {
    return sha256_of_set_file(directory, name) == digits;
  } catch (const std::invalid_argument&) {
    return false;  // missing, or no ordinary file
  }
}

}  // namespace

void require_new_bundle(const fs::path& directory) {
  if (!fs::exists(status_of(directory))) return;
  if (!fs::is_directory(directory) || !Directory(directory).names().empty())
    throw std::invalid_argument(fmt::format(
        "--bundle {}: is there already; expected the name of a new directory",
        directory.string()));
}

void write_bundle(const fs::path& directory, const Validator& validator,
                  const std::vector<BundleOutput>& outputs) {
  require_new_bundle(directory);
  fs::create_directories(directory);
  CopyNames names;
  const std::vector<BundleInput> copies = copies_of(validator.inputs(), names);
  for (const BundleInput& copy : copies)
    publish_text(directory, copy.name, copy.text);
  for (const BundleOutput& output : outputs)
    publish_text(directory, output.name, output.text);
  const ValidationRequest& request = validator.request();
  const Json json{{"filetype", kBundleFiletype},
                  {"format_version", 1},
                  {"beamgyro_version", request.program_version},
                  {"git_revision", request.git_revision},
                  {"request", request_json(request, names)},
                  {"inputs", hashes_of(copies)},
                  {"outputs", hashes_of(outputs)}};
  publish_text(directory, kBundleName, json.dump(2) + "\n");
}

Bundle read_bundle(const fs::path& directory) {
  const std::string place = (directory / kBundleName).string();
  const Json json = parse_json(read_text_file(place), place);
  const JsonNode root(json, place);
  if (root.at("filetype").text() != kBundleFiletype)
    root.at("filetype")
        .fail(fmt::format("is not \"{}\", what a bundle has", kBundleFiletype));
  root.at("format_version").integer(1, 1);
  Bundle bundle;
  bundle.program_version = root.at("beamgyro_version").text();
  bundle.git_revision = root.at("git_revision").text();
  bundle.request = request_from(directory, root.at("request"));
  for (const JsonNode& input : root.at("inputs").elements()) {
    bundle.inputs.push_back(input.at("file").text());
    if (!has_bytes(directory, bundle.inputs.back(), input.at("sha256").text()))
      bundle.changed.push_back(bundle.inputs.back());
  }
  for (const JsonNode& output : root.at("outputs").elements())
    bundle.outputs.push_back(output.at("file").text());
  return bundle;
}

std::vector<std::string> different_outputs(
    const fs::path& directory, const std::vector<BundleOutput>& outputs) {
  std::vector<std::string> different;
  for (const BundleOutput& output : outputs)
    if (!has_bytes(directory, output.name, sha256(output.text)))
      different.push_back(output.name);
  return different;
}

}  // namespace beamgyro
