// SPDX-License-Identifier: MIT
#include "validation/external/program_search.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <system_error>

#include "validation/external/command_words.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestFirstLine = 256;  // bytes, as the kernel reads

bool can_run(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

bool is_readable(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) ::close(descriptor);
  return descriptor >= 0;
}

// A program in a folder "bin" is part of what lies beside that.
fs::path whole_of(const fs::path& program) {
  const fs::path folder = program.parent_path();
  return folder.filename() == "bin" ? folder.parent_path() : program;
}

std::vector<fs::path> folders_of(const std::string& search_path) {
  std::vector<fs::path> folders;
  for (std::size_t begin = 0; begin < search_path.size();) {
    const std::size_t end =
        std::min(search_path.find(':', begin), search_path.size());
    folders.emplace_back(search_path.substr(begin, end - begin));
    begin = end + 1;
  }
  return folders;
}

}  // namespace

ProgramSearch::ProgramSearch(const std::string& command,
                             const std::string& search_path)
    : folders_(folders_of(search_path)) {
  for (const CommandWord& word : command_words(command)) {
    const std::optional<fs::path> file = program_of(word.text);
    if (!file) continue;
    add(*file, word.is_program);
    if (word.is_program) add_interpreter(*file);
  }
}

std::optional<fs::path> ProgramSearch::program_of(
    const std::string& name) const {
  if (name.find('/') != name.npos)
    return can_run(name) ? std::optional<fs::path>(name) : std::nullopt;
  for (const fs::path& folder : folders_)
    if (!name.empty() && can_run(folder / name)) return folder / name;
  return std::nullopt;
}

// An argument that only looks like a program may be out of reach, unless a
// wrapper such as nice would run another one of that name.
void ProgramSearch::add(const fs::path& file, bool is_run) {
  const fs::path folder = file.parent_path();
  for (const fs::path& settings :
       {folder / "pyvenv.cfg", folder.parent_path() / "pyvenv.cfg"})
    add_probe(settings, {file, whole_of(fs::absolute(file))});
  std::error_code error;
  const fs::path program = fs::canonical(file, error);
  const bool has_other = std::ranges::any_of(folders_, [&](const fs::path& in) {
    const fs::path other = in / file.filename();
    return can_run(other) && fs::canonical(other, error) != program;
  });
  if (is_run || has_other) add_probe(file, {file, whole_of(program)});
}

// The programs in the line "#!PROGRAM ARGUMENT" of a script.
void ProgramSearch::add_interpreter(const fs::path& script) {
  std::string line(kLongestFirstLine, '\0');
  std::ifstream file(script, std::ios::binary);
  file.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(file.gcount()));
  if (!line.starts_with("#!")) return;
  line = line.substr(2, line.find('\n') - 2);
  for (const CommandWord& word : command_words(line))
    if (const auto program = program_of(word.text)) add(*program, true);
}

void ProgramSearch::add_probe(const fs::path& file,
                              const UnreachableProgram& program) {
  if (is_readable(file)) probes_.push_back({file, program});
}

std::optional<UnreachableProgram> ProgramSearch::unreachable() const {
  for (const Probe& probe : probes_)
    if (!is_readable(probe.file)) return probe.program;
  return std::nullopt;
}

}  // namespace beamgyro::internal
