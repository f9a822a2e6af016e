// SPDX-License-Identifier: MIT
#include "validation/bundle/bundle.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"
#include "dataset/files/json_text.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "dataset/set/source_copies.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A file of a bundle.
struct BundleInput {
  std::string name;  // inputs/GROUP/...
  std::string text;
};

// Returns the copies of all inputs. Those of a group stand to each other as the
// originals do, so that the names in them stay valid.
std::vector<BundleInput> copies_of(const std::vector<ValidationInput>& inputs,
                                   InputNames& names) {
  std::vector<std::string> groups;
  for (const ValidationInput& input : inputs)
    if (std::ranges::count(groups, input.group) == 0)
      groups.push_back(input.group);
  std::vector<BundleInput> copies;
  for (const std::string& group : groups) {
    std::vector<SourceText> texts;
    for (const ValidationInput& input : inputs)
      if (input.group == group) texts.push_back({input.path, input.text});
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

// The files of a bundle while it is written. Unless keep() is called, they are
// removed again.
class UnfinishedBundle {
 public:
  explicit UnfinishedBundle(fs::path directory)
      : directory_(std::move(directory)) {}
  ~UnfinishedBundle() {
    std::error_code ignored;
    for (const std::string& name : names_) {
      fs::path path = name;
      fs::remove(directory_ / path, ignored);
      while (!(path = path.parent_path()).empty())
        fs::remove(directory_ / path, ignored);  // unless it has other files
    }
  }
  UnfinishedBundle(const UnfinishedBundle&) = delete;
  UnfinishedBundle& operator=(const UnfinishedBundle&) = delete;

  void write(const std::string& name, const std::string& text) {
    names_.push_back(name);
    publish_file(directory_, name, std::as_bytes(std::span(text)));
  }

  void keep() { names_.clear(); }

 private:
  fs::path directory_;
  std::vector<std::string> names_;
};

// What is larger than it claims is not hashed: a file of a few bytes on the
// disk may have holes of terabytes.
bool has_bytes(const fs::path& directory, const ListedFile& file) {
  try {
    return open_set_file(directory, file.name, O_RDONLY).size() == file.bytes &&
           sha256_of_set_file(directory, file.name) == file.sha256;
  } catch (const std::invalid_argument&) {
    return false;  // missing, or no ordinary file
  }
}

ListedFile listed(const std::string& name, const std::string& text) {
  return {name, text.size(), sha256(text)};
}

std::vector<std::string> files_of(const fs::path& directory) try {
  return Directory(directory).files_below();
} catch (const std::system_error& error) {
  throw_file_error(directory, "cannot read", error.code());
}

// Whether a directory holds the first files of a bundle and nothing else. They
// are written in the order of `copies`, and outputs follow.
bool is_begun(const fs::path& directory,
              const std::vector<BundleInput>& copies) {
  std::vector<std::string> files = files_of(directory);
  std::erase_if(files, [](const std::string& file) {
    return is_partial_file(fs::path(file).filename().string());
  });
  const std::size_t all = files.size();
  for (const BundleInput& copy : copies)
    if (std::ranges::count(files, copy.name) > 0 &&
        has_bytes(directory, listed(copy.name, copy.text)))
      std::erase(files, copy.name);
  if (all - files.size() == copies.size())
    for (const char* output :
         {kResultFile, kReportFile, kPageFile, kTrainedFile})
      std::erase(files, output);
  return files.empty();
}

void require_new(const fs::path& directory,
                 const std::vector<BundleInput>& copies) {
  const fs::file_status status = status_of(directory);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status) || !is_begun(directory, copies))
    throw std::invalid_argument(fmt::format(
        "--bundle {}: is there already; expected the name of a new directory",
        directory.string()));
}

// Removes the partial files that dead processes left in a begun bundle.
void remove_partial_files_of(const fs::path& directory) try {
  const Directory bundle(directory);
  std::set<fs::path> places;
  for (const std::string& file : bundle.files_below())
    places.insert(fs::path(file).parent_path());
  for (const fs::path& place : places)
    remove_dead_partial_files(bundle.subdirectory(place), false);
} catch (const std::system_error& error) {
  throw_file_error(directory, "cannot remove unfinished files", error.code());
}

Json hashes_of(const auto& files) {
  Json list = Json::array();
  for (const auto& file : files)
    list.push_back({{"file", file.name},
                    {"bytes", file.text.size()},
                    {"sha256", sha256(file.text)}});
  return list;
}

// Returns bundle.json.
std::string bundle_text(const BundleContent& content,
                        const std::vector<BundleInput>& copies,
                        const InputNames& names,
                        const std::vector<BundleOutput>& outputs) {
  const Json json{{"filetype", kBundleFiletype},
                  {"format_version", kBundleVersion},
                  {"beamgyro_version", content.program_version},
                  {"git_revision", content.git_revision},
                  {"request", content.request(names)},
                  {"inputs", hashes_of(copies)},
                  {"outputs", hashes_of(outputs)}};
  return json_text(json);
}

}  // namespace

void require_new_bundle(const fs::path& directory,
                        const BundleContent& content) {
  InputNames names;
  if (fs::is_directory(status_of(directory)) && !files_of(directory).empty())
    require_new(directory, copies_of(content.inputs, names));
  else
    require_new(directory, {});
}

void write_bundle(const fs::path& directory, const BundleContent& content,
                  const std::vector<BundleOutput>& outputs) {
  InputNames names;
  const std::vector<BundleInput> copies = copies_of(content.inputs, names);
  require_new(directory, copies);
  const MadeDirectories made(directory);
  remove_partial_files_of(directory);
  UnfinishedBundle files(directory);
  for (const BundleInput& copy : copies) files.write(copy.name, copy.text);
  for (const BundleOutput& output : outputs)
    files.write(output.name, output.text);
  files.write(kBundleFile, bundle_text(content, copies, names, outputs));
  files.keep();
}

std::vector<BundleDifference> changed_files(const Bundle& bundle) {
  std::vector<BundleDifference> changed;
  std::set<std::string> listed{kBundleFile};
  for (const auto* files : {&bundle.inputs, &bundle.outputs})
    for (const ListedFile& file : *files) {
      listed.insert(file.name);
      if (!has_bytes(bundle.directory, file))
        changed.push_back({bundle.directory / file.name, "is not the same"});
    }
  for (const std::string& file : files_of(bundle.directory))
    if (!listed.contains(file))
      changed.push_back(
          {bundle.directory / file, "is not listed in bundle.json"});
  return changed;
}

std::vector<BundleDifference> different_inputs(const Bundle& bundle,
                                               const BundleContent& content) {
  const auto place = [](const fs::path& path) {
    return fs::absolute(path).lexically_normal();
  };
  std::set<fs::path> listed, read;
  for (const ListedFile& input : bundle.inputs)
    listed.insert(place(bundle.directory / input.name));
  std::vector<BundleDifference> different;
  for (const ValidationInput& input : content.inputs)
    if (read.insert(place(input.path)).second &&
        !listed.contains(place(input.path)))
      different.push_back({input.path, "is read and not in the bundle"});
  for (const ListedFile& input : bundle.inputs)
    if (const fs::path path = bundle.directory / input.name;
        !read.contains(place(path)))
      different.push_back({path, "is listed as an input and not read"});
  return different;
}

std::vector<BundleDifference> different_outputs(
    const Bundle& bundle, BundleContent content,
    const std::vector<BundleOutput>& outputs) {
  std::vector<BundleDifference> different;
  for (const BundleOutput& output : outputs)
    if (!has_bytes(bundle.directory, listed(output.name, output.text)))
      different.push_back({bundle.directory / output.name, "is not the same"});
  if (!different.empty()) return different;
  InputNames names;
  const std::vector<BundleInput> copies = copies_of(content.inputs, names);
  content.program_version = bundle.program_version;
  content.git_revision = bundle.git_revision;
  const std::string text = bundle_text(content, copies, names, outputs);
  if (!has_bytes(bundle.directory, listed(kBundleFile, text)))
    different.push_back({bundle.directory / kBundleFile, "is not the same"});
  return different;
}

}  // namespace beamgyro::internal
