// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/result/validator.h"

namespace beamgyro {

/// A file that a validation writes.
struct BundleOutput {
  std::string name;  // below the directory: "result.json"
  std::string text;
};

/// Writes a bundle (docs/reference/bundle.md): copies of all inputs below
/// inputs/, the outputs, and at last bundle.json with the request, versions and
/// hashes. Throws std::invalid_argument when the directory is there and not
/// empty, and as publish_file().
void write_bundle(const std::filesystem::path& directory,
                  const Validator& validator,
                  const std::vector<BundleOutput>& outputs);

/// Throws what write_bundle() would throw for the name of the directory.
void require_new_bundle(const std::filesystem::path& directory);

/// A bundle as bundle.json describes it.
struct Bundle {
  ValidationRequest request;                  // of its inputs, without versions
  std::string program_version, git_revision;  // that made it
  std::vector<std::string> inputs, outputs;   // names below the directory
  std::vector<std::string> changed;  // inputs that have other bytes, or none
};

/// Reads bundle.json and compares the inputs with their hashes. Throws
/// std::invalid_argument when there is no bundle or bundle.json is damaged.
Bundle read_bundle(const std::filesystem::path& directory);

/// Returns the names of the outputs of a bundle that are missing or have other
/// bytes than `outputs`, which were made again.
std::vector<std::string> different_outputs(
    const std::filesystem::path& directory,
    const std::vector<BundleOutput>& outputs);

}  // namespace beamgyro
