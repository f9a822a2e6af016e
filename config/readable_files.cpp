// SPDX-License-Identifier: MIT
#include "config/readable_files.h"

#include <fmt/format.h>

#include <mutex>
#include <set>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

std::filesystem::path place_of(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

std::mutex one_at_a_time;

}  // namespace

struct ReadableFiles::State {
  static State* active;  // guarded by one_at_a_time, as all of it

  std::set<std::filesystem::path> files;
  std::optional<std::filesystem::path> refused;
};

ReadableFiles::State* ReadableFiles::State::active = nullptr;

ReadableFiles::ReadableFiles(const std::vector<std::filesystem::path>& files)
    : state_(std::make_unique<State>()) {
  for (const std::filesystem::path& file : files)
    state_->files.insert(place_of(file));
  const std::lock_guard lock(one_at_a_time);
  State::active = state_.get();
}

ReadableFiles::~ReadableFiles() {
  const std::lock_guard lock(one_at_a_time);
  State::active = nullptr;
}

std::optional<std::filesystem::path> ReadableFiles::refused() const {
  const std::lock_guard lock(one_at_a_time);
  return state_->refused;
}

void require_readable(const std::filesystem::path& file) {
  const std::lock_guard lock(one_at_a_time);
  ReadableFiles::State* const active = ReadableFiles::State::active;
  if (active == nullptr || active->files.contains(place_of(file))) return;
  if (!active->refused) active->refused = file;
  throw std::invalid_argument(fmt::format(
      "{}: is none of the files that may be read here", file.string()));
}

}  // namespace beamgyro::internal
