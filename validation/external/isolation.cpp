// SPDX-License-Identifier: MIT
#include "validation/external/isolation.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/option_message.h"
#include "dataset/files/directory.h"
#include "dataset/files/file_place.h"
#include "dataset/files/hdf5_signature.h"
#include "dataset/files/open_file.h"
#include "dataset/files/sha256.h"
#include "validation/external/child_process.h"
#include "validation/external/command_compensator.h"
#include "validation/external/command_words.h"
#include "validation/external/plugin_host.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSystemFolders[] = {"/usr",  "/lib", "/lib64", "/bin",
                                          "/sbin", "/etc", "/opt"};

constexpr double kLongestTry = 60.0;  // [s]

// Endings of programs that a word of a command may name; others begin with
// "#!" or are ELF.
constexpr std::string_view kScriptEndings[] = {
    ".awk", ".class", ".jar", ".jl",  ".js", ".lua", ".m",  ".mjs",
    ".php", ".pl",    ".py",  ".pyc", ".rb", ".R",   ".sh", ".tcl"};

constexpr std::string_view kProgramStart =
    "\x7f"
    "ELF";

bool is_hdf5(const fs::path& path) {
  OpenFile file(path, O_RDONLY);
  return is_hdf5_file(file);
}

bool is_code(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  std::array<char, 4> head{};
  file.read(head.data(), head.size());
  const std::string_view first(head.data(), head.size());
  const std::string ending = path.extension().string();
  const bool is_named_so = std::ranges::count(kScriptEndings, ending) > 0;
  return (first == kProgramStart || first.starts_with("#!") || is_named_so) &&
         !is_hdf5(path);
}

// Which of the hidden places a file or folder is, or holds.
std::optional<fs::path> hidden_in(const fs::path& place,
                                  const IsolationOptions& options) {
  std::error_code error;
  for (const fs::path& hidden : options.hidden) {
    if (hidden.empty()) continue;  // in memory
    if (is_within(canonical_place(hidden), place) ||
        is_within(place, canonical_place(hidden)) ||
        fs::equivalent(place, hidden, error))
      return hidden;
  }
  return std::nullopt;
}

// Adds a folder of the system, or where it holds what is hidden its entries.
void add_without_hidden(const fs::path& place, const IsolationOptions& options,
                        std::vector<fs::path>& readable) {
  if (!hidden_in(place, options)) {
    readable.push_back(place);
    return;
  }
  std::error_code error;
  if (!fs::is_directory(place, error)) return;
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(place, error))
    if (!entry.is_symlink(error)) entries.push_back(entry.path());
  std::ranges::sort(entries);
  for (const fs::path& entry : entries)
    add_without_hidden(entry, options, readable);
}

std::string sum_of_folder(const fs::path& folder) {
  const Directory directory(folder);
  std::vector<std::string> names = directory.files_below();
  std::ranges::sort(names);
  Sha256 sum;
  for (const std::string& name : names) {
    const std::optional<FileFacts> facts = directory.find(name);
    if (!facts || !facts->is_regular) continue;
    const std::string digits = sha256_of_file(folder / name);
    if (is_hdf5(folder / name))
      throw option_error(
          "{}: holds {}, which is an HDF5 file, as recordings are; expected "
          "files and folders of programs",
          NamedOption{"plugin_files", folder.string()}, name);
    const std::string line = fmt::format("{}{}{}\n", name, '\0', digits);
    sum.add(std::as_bytes(std::span(line)));
  }
  return sum.digits();
}

AllowedFile allowed_plugin_file(const fs::path& path,
                                const IsolationOptions& options) {
  const NamedOption named{"plugin_files", path.string()};
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  if (!is_folder && !fs::is_regular_file(path, error))
    throw option_error("{}: No such file or directory", named);
  if (const auto hidden = hidden_in(canonical_place(path), options))
    throw option_error(
        "{}: is, holds or lies in {}, which the compensator is judged by; "
        "expected files and folders of programs",
        named, hidden->string());
  AllowedFile file{canonical_place(path).filename().string(),
                   is_folder ? sum_of_folder(path) : sha256_of_file(path)};
  if (!is_folder && is_hdf5(path))
    throw option_error(
        "{}: is an HDF5 file, as recordings are; expected files and folders of "
        "programs",
        named);
  return file;
}

// Adds what is not readable yet.
void allow(const fs::path& path, AllowedFile file, Isolation& isolation) {
  const fs::path place = canonical_place(path);
  for (const fs::path& other : isolation.readable)
    if (is_within(place, other)) return;
  isolation.readable.push_back(place);
  isolation.files.push_back(std::move(file));
}

void add_plugin_files(const IsolationOptions& options, Isolation& isolation) {
  for (const fs::path& path : options.plugin_files)
    allow(path, allowed_plugin_file(path, options), isolation);
}

void add_system(const IsolationOptions& options, Isolation& isolation) {
  for (const char* folder : kSystemFolders) {
    const fs::path place =
        canonical_place(folder);  // /bin may be a link to /usr/bin
    if (fs::exists(place) && std::ranges::count(isolation.readable, place) == 0)
      add_without_hidden(place, options, isolation.readable);
  }
}

// Whether the words of a command may open a file: what is no code may be a
// recording in some form.
bool is_named_code(const fs::path& path, const IsolationOptions& options) {
  return is_code(path) && !hidden_in(canonical_place(path), options);
}

// Throws for a program "FILE\nPLUGIN_FILES" that is out of reach.
[[noreturn]] void refuse_program(const std::string& argument,
                                 const std::string& text) {
  const std::size_t end = text.find('\n');
  throw option_error(
      "{}: {} lies where a command may not read; expected {}, or a program of "
      "the system",
      argument, text.substr(0, end),
      NamedOption{"plugin_files", text.substr(end + 1)});
}

// Starts a process that isolates itself and looks for the programs of
// `command`.
void try_isolation(const std::string& argument, const std::string& command,
                   const ProcessLimits& limits, Isolation& isolation) {
  isolation.landlock = limits.isolation.highest_landlock;
  ChildProcess process(host_start(limits, isolation, HostTask::kTry, command));
  process.input().reset();
  bool in_time = true;
  const std::string words =
      read_until_end(*process.error(), kLongestTry, in_time);
  const std::optional<ProcessEnd> end =
      in_time ? process.wait(kLongestTry) : std::nullopt;
  if (!end)
    isolation.refusal = "the process that tries it hangs";
  else if (end->signal != 0)
    isolation.refusal = "the process that tries it " + end_words(*end);
  else if (end->status == kProgramOutOfReach)
    refuse_program(argument, words);
  else if (end->status != 0)
    isolation.refusal = words.empty() ? end_words(*end) : words;
}

void isolate(const std::string& argument, const std::string& command,
             const ProcessLimits& limits, Isolation& isolation) {
  add_plugin_files(limits.isolation, isolation);
  if (limits.isolation.highest_landlock == 0)
    isolation.refusal = "it is not asked for";
  else if (limits.program.empty())
    isolation.refusal = "the program beamgyro, which isolates it, is not named";
  else
    try_isolation(argument, command, limits, isolation);
  if (isolation.holds()) return;
  isolation.landlock = 0;
  if (limits.isolation.required)
    throw option_error("{}: {} is {}", NamedOption{"require_isolation"},
                       argument, isolation_words(isolation));
}

}  // namespace

std::string isolation_words(const Isolation& isolation) {
  return isolation.holds() ? "isolated" : "not isolated: " + isolation.refusal;
}

Isolation isolation_of_system(const ProcessLimits& limits) {
  ProcessLimits any = limits;
  any.isolation.plugin_files.clear();
  any.isolation.required = false;
  Isolation isolation;
  add_system(limits.isolation, isolation);
  isolate("", "", any, isolation);
  return isolation;
}

Isolation isolation_of_command(const std::string& argument,
                               const ProcessLimits& limits) {
  Isolation isolation;
  add_system(limits.isolation, isolation);
  const std::string command = command_of(argument);
  for (const CommandWord& word : command_words(command))
    if (is_named_code(word.text, limits.isolation))
      allow(word.text,
            {canonical_place(word.text).filename().string(),
             sha256_of_file(word.text)},
            isolation);
  isolate(argument, command, limits, isolation);
  return isolation;
}

Isolation isolation_of_library(const fs::path& library,
                               const ProcessLimits& limits) {
  Isolation isolation;
  add_system(limits.isolation, isolation);
  isolation.readable.push_back(canonical_place(library));
  isolate(library.string(), "", limits, isolation);
  return isolation;
}

}  // namespace beamgyro::internal
