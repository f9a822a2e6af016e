// SPDX-License-Identifier: MIT
// The lines of a manifest without their checksums, which are put in here so
// that a change of a line is not all that is ever found; and the check of a set
// of which nothing else is there.
#include <filesystem>
#include <string>

#include "dataset/files/sha256.h"
#include "dataset/set/set_check.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

std::string with_checksums(std::string_view lines) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    std::string line(lines.substr(0, end));
    lines.remove_prefix(end == std::string_view::npos ? lines.size() : end + 1);
    if (line == "end")
      line = "{\"sha256_before\":\"" + beamgyro::internal::sha256(text) + "\"}";
    if (line.ends_with('}')) {
      line.pop_back();
      line += ",\"check\":\"" + beamgyro::internal::sha256(line).substr(0, 16) +
              "\"}";
    }
    text += line + '\n';
  }
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  const std::filesystem::path set = scratch_folder() / "set";
  std::filesystem::create_directory(set);
  scratch_file("set/manifest.jsonl", with_checksums(text_of(data, size)));
  accept_or_reject([&] {
    static_cast<void>(check_set(set, read_manifest(set, kManifestName)));
  });
  return 0;
}
