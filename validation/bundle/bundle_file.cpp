// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "dataset/files/json_node.h"
#include "dataset/files/text_file.h"
#include "validation/bundle/bundle.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Throws when an object has other keys. Missing ones are found when read.
void require_known_keys(const JsonNode& node, const Json& object,
                        std::initializer_list<const char*> known) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      node.fail(fmt::format("\"{}\": unknown key; expected one of {}", key,
                            fmt::join(known, ", ")));
}

// Returns the name of a file, which is below the directory of its bundle.
std::string plain_name(const JsonNode& node) {
  const std::string name = node.text();
  const fs::path normal = fs::path(name).lexically_normal();
  const bool leads_out = name.empty() || name == "." || name.ends_with('/') ||
                         name.find('\0') != std::string::npos ||
                         normal.string() != name || normal.is_absolute() ||
                         *normal.begin() == "..";
  if (leads_out)
    node.fail(fmt::format(
        "\"{}\": expected the name of a file below the bundle", name));
  return name;
}

std::vector<ListedFile> listed_files(const JsonNode& list, const Json& json,
                                     bool are_inputs) {
  std::vector<ListedFile> files;
  std::set<std::string> names;
  const std::vector<JsonNode> elements = list.elements();
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const JsonNode file = elements[k].at("file");
    require_known_keys(elements[k], json[k], {"file", "sha256"});
    files.push_back({plain_name(file), elements[k].at("sha256").text()});
    const std::string& name = files.back().name;
    if (!names.insert(name).second)
      file.fail(fmt::format("\"{}\" is there twice; expected it once", name));
    if (name.starts_with("inputs/") != are_inputs || name == kBundleFile)
      file.fail(fmt::format("\"{}\": expected a name {} inputs/", name,
                            are_inputs ? "below" : "outside"));
  }
  return files;
}

// Reads the names of a request, which are those of inputs.
class RequestNames {
 public:
  explicit RequestNames(const Bundle& bundle) : bundle_(bundle) {}

  fs::path path(const JsonNode& node) const {
    const std::string name = plain_name(node);
    if (std::ranges::count(bundle_.inputs, name, &ListedFile::name) == 0)
      node.fail(fmt::format(
          "\"{}\": is not in \"inputs\"; expected one that is", name));
    return bundle_.directory / name;
  }

  std::optional<fs::path> optional_path(const JsonNode& node) const {
    if (node.is_null()) return {};
    return path(node);
  }

 private:
  const Bundle& bundle_;
};

// Throws for a request that no command line could make.
void require_sound(const JsonNode& node, const ValidationRequest& request) {
  const bool has_device = request.device.has_value();
  if (has_device == !request.runs.empty())
    node.fail("expected either a device or runs");
  if (has_device != !request.qualification.empty())
    node.at("qualification").fail("expected one with a device, else null");
  if (has_device && request.full_scale)
    node.at("full_scale_deg_per_s").fail("expected null, with a device");
  if (request.full_scale && *request.full_scale <= 0)
    node.at("full_scale_deg_per_s").fail("expected a number above 0");
  if (!has_device && request.campaign)
    node.at("campaign").fail("expected null, without a device");
  if (request.devices && !request.campaign)
    node.at("devices").fail("expected null, without a campaign");
  for (const fs::path& run : request.runs)
    if (std::ranges::count(request.runs, run) > 1)
      node.at("runs").fail("has one twice; expected each once");
}

ValidationRequest request_from(const Bundle& bundle, const JsonNode& node,
                               const Json& json) {
  const RequestNames names(bundle);
  ValidationRequest request;
  const JsonNode compensator = node.at("compensator");
  require_known_keys(
      node, json,
      {"compensator", "device", "qualification", "runs", "full_scale_deg_per_s",
       "specification", "workbench", "campaign", "devices"});
  request.compensator = compensator.text();
  if (!is_command(request.compensator))
    request.compensator = names.path(compensator).string();
  request.device = names.optional_path(node.at("device"));
  request.qualification =
      names.optional_path(node.at("qualification")).value_or(fs::path());
  for (const JsonNode& run : node.at("runs").elements())
    request.runs.push_back(names.path(run));
  request.full_scale = node.at("full_scale_deg_per_s").optional_number();
  request.specification = names.optional_path(node.at("specification"));
  request.workbench = names.optional_path(node.at("workbench"));
  request.campaign = names.optional_path(node.at("campaign"));
  if (const JsonNode devices = node.at("devices"); !devices.is_null())
    request.devices = devices.integer(1, 4'000'000'000);
  require_sound(node, request);
  return request;
}

}  // namespace

Bundle read_bundle(const fs::path& directory) {
  const std::string place = (directory / kBundleFile).string();
  const Json json = parse_json(read_text_file(place), place);
  const JsonNode root(json, place);
  if (root.at("filetype").text() != kBundleFiletype)
    root.at("filetype")
        .fail(fmt::format("is not \"{}\", what a bundle has", kBundleFiletype));
  root.at("format_version").integer(1, 1);
  require_known_keys(root, json,
                     {"filetype", "format_version", "beamgyro_version",
                      "git_revision", "request", "inputs", "outputs"});
  Bundle bundle{.directory = directory,
                .request = {},
                .program_version = root.at("beamgyro_version").text(),
                .git_revision = root.at("git_revision").text(),
                .inputs = {},
                .outputs = {}};
  const JsonNode request = root.at("request");
  bundle.inputs = listed_files(root.at("inputs"), json["inputs"], true);
  bundle.outputs = listed_files(root.at("outputs"), json["outputs"], false);
  bundle.request = request_from(bundle, request, json["request"]);
  return bundle;
}

}  // namespace beamgyro::internal
