// SPDX-License-Identifier: MIT
#include "tests/fuzz/fuzz_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <span>
#include <string>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct ScratchFolder {
  fs::path path;

  ScratchFolder() {
    const fs::path memory = "/dev/shm";
    const bool has_memory = access(memory.c_str(), W_OK) == 0;
    std::string name = (has_memory ? memory : fs::temp_directory_path()) /
                       "beamgyro-fuzz-XXXXXX";
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error(name + ": cannot make the directory");
    path = name;
    const fs::path shipped = BEAMGYRO_SCENARIOS;
    fs::copy(shipped / "devices", path / "devices");
    fs::copy(shipped / "profiles", path / "profiles");
    for (const fs::directory_entry& entry : fs::directory_iterator(shipped))
      if (entry.is_regular_file()) fs::copy(entry.path(), path);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

std::pair<std::string_view, std::string_view> split(std::string_view text) {
  constexpr std::string_view kBorder = "=====\n";
  const std::size_t place = text.find(kBorder);
  if (place == std::string_view::npos) return {text, {}};
  return {text.substr(0, place), text.substr(place + kBorder.size())};
}

const fs::path& scratch_folder() {
  static const ScratchFolder folder;
  return folder.path;
}

fs::path scratch_file(std::string_view name, std::string_view bytes) {
  const fs::path path = scratch_folder() / name;
  OpenFile file(path, O_WRONLY | O_CREAT | O_TRUNC);
  file.write(std::as_bytes(std::span(bytes)));
  file.close();
  return path;
}

}  // namespace beamgyro::internal
