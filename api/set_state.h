// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard_reader.h"
#include "include/beamgyro/set.h"

namespace beamgyro {

struct Set::State {
  /// Place of a device in a file.
  struct Place {
    std::shared_ptr<const internal::ShardFile> file;
    std::uint32_t position;
  };

  std::filesystem::path directory;
  internal::Manifest manifest;  // finished
  std::vector<SetFailure> failures;

  const internal::ManifestHead& head() const { return *manifest.head; }

  /// Opens the file, compares its bytes with the manifest, and keeps the few
  /// that were used last open. Throws as Set::part().
  Place place_of(std::string_view run, std::uint32_t device) const;

 private:
  std::shared_ptr<const internal::ShardFile> file_of(std::uint32_t index) const;

  mutable std::mutex mutex_;
  mutable std::map<std::uint32_t, std::shared_ptr<const internal::ShardFile>>
      open_;
};

}  // namespace beamgyro
