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
    require_known_keys(elements[k], json[k], {"file", "bytes", "sha256"});
    files.push_back({plain_name(file),
                     elements[k].at("bytes").unsigned_integer(),
                     elements[k].at("sha256").text()});
    const std::string& name = files.back().name;
    if (!names.insert(name).second)
      file.fail(fmt::format("\"{}\" is there twice; expected it once", name));
    if (name.starts_with("inputs/") != are_inputs || name == kBundleFile)
      file.fail(fmt::format("\"{}\": expected a name {} inputs/", name,
                            are_inputs ? "below" : "outside"));
  }
  return files;
}

}  // namespace

std::string listed_name(const Bundle& bundle, const JsonNode& value) {
  std::string name = plain_name(value);
  if (std::ranges::count(bundle.inputs, name, &ListedFile::name) == 0)
    value.fail(fmt::format("\"{}\": is not in \"inputs\"; expected one that is",
                           name));
  return name;
}

Bundle read_bundle(const fs::path& directory) {
  const std::string place = (directory / kBundleFile).string();
  const Json json =
      parse_json(read_json_text(place, "that of a bundle"), place);
  const JsonNode root(json, place);
  if (root.at("filetype").text() != kBundleFiletype)
    root.at("filetype")
        .fail(fmt::format("is not \"{}\", what a bundle has", kBundleFiletype));
  root.at("format_version").integer(kBundleVersion, kBundleVersion);
  require_known_keys(root, json,
                     {"filetype", "format_version", "beamgyro_version",
                      "git_revision", "request", "inputs", "outputs"});
  Bundle bundle{.directory = directory,
                .request = {},
                .program_version = root.at("beamgyro_version").text(),
                .git_revision = root.at("git_revision").text(),
                .inputs = {},
                .outputs = {}};
  bundle.inputs = listed_files(root.at("inputs"), json["inputs"], true);
  bundle.outputs = listed_files(root.at("outputs"), json["outputs"], false);
  root.at("request");  // or throws
  bundle.request = json["request"];
  return bundle;
}

}  // namespace beamgyro::internal
