// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "dataset/files/json_node.h"

namespace beamgyro::internal {

inline constexpr const char* kBundleFile = "bundle.json";
inline constexpr const char* kBundleFiletype = "beamgyro-bundle";

/// Names of the files that a validation writes, below the bundle.
// Since 2 with the sizes of files.
inline constexpr long kBundleVersion = 2;
inline constexpr const char* kResultFile = "result.json";
inline constexpr const char* kReportFile = "report.txt";
inline constexpr const char* kPageFile = "report/index.html";
inline constexpr const char* kTrainedFile = "trained.json";  // of a model

/// A file that a validation writes.
struct BundleOutput {
  std::string name;
  std::string text;
};

/// A file that a result depends on.
struct ValidationInput {
  std::string group;  // "device", ...; names in a file are of its group
  std::filesystem::path path;
  std::string sha256;
  std::string text;  // as it was read; empty where it was not kept
};

/// Names of the copies of inputs below a bundle, by group and path.
using InputNames =
    std::map<std::pair<std::string, std::filesystem::path>, std::string>;

/// What a bundle holds beside its outputs.
struct BundleContent {
  const std::vector<ValidationInput>& inputs;  // with their texts
  // Returns what was asked for, in the names of the copies.
  std::function<nlohmann::ordered_json(const InputNames&)> request;
  std::string program_version, git_revision;
};

/// Writes a bundle (docs/reference/bundle.md): copies of all inputs below
/// inputs/, the outputs, and at last bundle.json with the request, versions and
/// hashes. When that fails, the files written are removed. Throws as
/// require_new_bundle() and publish_file().
void write_bundle(const std::filesystem::path& directory,
                  const BundleContent& content,
                  const std::vector<BundleOutput>& outputs);

/// Throws std::invalid_argument unless the directory is new, empty, or holds
/// what an interrupted command has left of the same bundle.
void require_new_bundle(const std::filesystem::path& directory,
                        const BundleContent& content);

/// A file as bundle.json lists it.
struct ListedFile {
  std::string name;  // below the directory, which it does not lead out of
  std::uint64_t bytes = 0;
  std::string sha256;  // in hexadecimal digits
};

/// A file of a bundle that is not what it has to be.
struct BundleDifference {
  std::filesystem::path file;
  std::string words;  // "is not the same"
};

/// A bundle as bundle.json describes it.
struct Bundle {
  std::filesystem::path directory;
  nlohmann::ordered_json request;             // in names of its inputs
  std::string program_version, git_revision;  // that made it
  std::vector<ListedFile> inputs, outputs;
};

/// Reads bundle.json and no other file. Throws std::invalid_argument when there
/// is none, or when it is damaged: when a key is unknown or missing, or a name
/// leads out of the directory or is there twice. The request is not read.
Bundle read_bundle(const std::filesystem::path& directory);

/// Returns the name of an input that a value of the request is. Throws
/// std::invalid_argument when the bundle has no such input.
std::string listed_name(const Bundle& bundle, const JsonNode& value);

/// Returns the listed files that are missing or have another size or hash, and
/// the files that are not listed. A file of another size is not hashed.
std::vector<BundleDifference> changed_files(const Bundle& bundle);

/// Returns the files that the validation reads and the bundle does not have,
/// and those that it has and the validation does not read.
std::vector<BundleDifference> different_inputs(const Bundle& bundle,
                                               const BundleContent& content);

/// Returns the files that have other bytes than `outputs`, which were made
/// again, and than the bundle.json that is made of all.
std::vector<BundleDifference> different_outputs(
    const Bundle& bundle, BundleContent content,
    const std::vector<BundleOutput>& outputs);

}  // namespace beamgyro::internal
