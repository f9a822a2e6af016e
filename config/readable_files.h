// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace beamgyro::internal {

/// While it lives, the texts of these files alone are read, by all threads:
/// what stands in a file of a stranger may name others. There is one at a time.
class ReadableFiles {
 public:
  explicit ReadableFiles(const std::vector<std::filesystem::path>& files);
  ~ReadableFiles();
  ReadableFiles(const ReadableFiles&) = delete;
  ReadableFiles& operator=(const ReadableFiles&) = delete;

  /// Returns the first file that was not read because it is none of them.
  std::optional<std::filesystem::path> refused() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  friend void require_readable(const std::filesystem::path& file);
};

/// Called before a text is read. Throws std::invalid_argument for a file that
/// is none of the readable ones; without ReadableFiles all are.
void require_readable(const std::filesystem::path& file);

}  // namespace beamgyro::internal
