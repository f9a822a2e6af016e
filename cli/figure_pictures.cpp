// SPDX-License-Identifier: MIT
#include "cli/figure_pictures.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <thread>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/file_ending.h"
#include "validation/external/child_process.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScript = "python/beamgyro/plots/__main__.py";
constexpr const char* kPython = "/usr/bin/python3";
constexpr double kLongestDrawing = 600.0;  // [s]
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
// How the script ends when it says why in one line.
constexpr int kRefused = 2, kNotPossible = 3;

// What an ended process wrote to its standard error.
std::string errors_of(ChildProcess& process) {
  std::string text;
  process.error()->read_pieces([&](std::span<const std::byte> piece) {
    text.append(reinterpret_cast<const char*>(piece.data()), piece.size());
  });
  return text;
}

// The last line, as matplotlib may have warned before.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of('\n') + 1);
  return text.substr(text.find_last_of('\n') + 1);
}

// Writes all to the standard input of a process, unless that reads no more.
void give(ChildProcess& process, std::string_view text) {
  const NoBrokenPipeSignal quiet;
  while (process.input() && !text.empty()) {
    const std::size_t taken = write_available(process.input(), text);
    text.remove_prefix(taken);
    if (taken == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process.input().reset();
}

// Runs the script with `words` and `input`, and waits for it.
void run_script(const std::vector<std::string>& words, double most_seconds,
                std::string_view input = "") {
  const fs::path script = shipped_file(kScript);
  if (script.empty())
    throw std::runtime_error(fmt::format(
        "pictures need {}, which is not beside this program", kScript));
  // -B: no compiled files in the place of an installation.
  std::vector<std::string> command = {kPython, "-B", script.string()};
  command.insert(command.end(), words.begin(), words.end());
  ChildProcess process({command});
  give(process, input);
  const auto end = process.wait(most_seconds);
  if (!end)
    throw std::runtime_error(fmt::format("{}: still draws after {:.0f} s",
                                         script.string(), most_seconds));
  if (end->status == 0 && end->signal == 0) return;
  const std::string errors = errors_of(process);
  if (end->status == kRefused) throw std::invalid_argument(last_line(errors));
  if (end->status == kNotPossible) throw std::runtime_error(last_line(errors));
  throw std::runtime_error(fmt::format("{}: {}{}", script.string(),
                                       end_words(*end), last_words(errors)));
}

void draw_into(AtomicFile& picture, const fs::path& path,
               std::vector<std::string> words, std::string_view input = "") {
  words.push_back("--output=" + picture.partial_path().string());
  words.push_back("--format=" + file_ending(path).substr(1));
  run_script(words, kLongestDrawing, input);
  picture.publish();
}

std::vector<std::string> script_words(const std::vector<std::string>& files,
                                      bool compare) {
  std::vector<std::string> words = {"--curves"};
  if (compare) words.emplace_back("--compare");
  // A file may be called "-o".
  for (const std::string& file : files)
    words.push_back(file.starts_with('-') ? "./" + file : file);
  return words;
}

}  // namespace

fs::path shipped_file(const fs::path& name) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* place : {"../..", "../share/beamgyro"}) {
    fs::path file = (program / place / name).lexically_normal();
    if (fs::exists(status_of(file))) return file;
  }
  return {};
}

void draw_figures(const std::string& result, const fs::path& directory) {
  const fs::path json = directory / "result.json";
  write_text_file(json, result);
  run_script({json.string(), "--each", directory.string()}, kLongestDrawing);
}

void require_picture_name(std::string_view option, const fs::path& path) {
  const std::string ending = file_ending(path);
  if (ending != ".png" && ending != ".svg")
    throw std::invalid_argument(fmt::format(
        "{} {}: unknown kind of picture \"{}\"; expected a name that ends in "
        ".png or .svg",
        option, path.string(), path.extension().string()));
}

void draw_plan(const std::string& result, const fs::path& path) {
  AtomicFile picture(path);
  // The result lies beside the picture only as long as it is drawn.
  fs::path name = path;
  AtomicFile json(name += ".json");
  json.file().write(std::as_bytes(std::span(result)));
  draw_into(picture, path, {json.partial_path().string()});
}

void draw_files(const std::vector<std::string>& files,
                const std::string& curves, bool compare,
                const fs::path& picture) {
  AtomicFile file(picture);
  draw_into(file, picture, script_words(files, compare), curves);
}

void show_files(const std::vector<std::string>& files,
                const std::string& curves, bool compare) {
  run_script(script_words(files, compare), kNoLimit, curves);
}

}  // namespace beamgyro::internal
