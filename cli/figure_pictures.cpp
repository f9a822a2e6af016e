// SPDX-License-Identifier: MIT
#include "cli/figure_pictures.h"

#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "validation/external/child_process.h"
#include "validation/external/error_text.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestDrawing = 120.0;  // [s]

// What an ended process wrote to its standard error.
std::string errors_of(ChildProcess& process) {
  std::string text;
  process.error()->read_pieces([&](std::span<const std::byte> piece) {
    text.append(reinterpret_cast<const char*>(piece.data()), piece.size());
  });
  return text;
}

fs::path script_of(const FigureScript& drawn_by) {
  fs::path script = shipped_file(drawn_by.script);
  if (script.empty())
    throw std::runtime_error(
        fmt::format("{} needs {}, which is not beside this program",
                    drawn_by.option, drawn_by.script));
  return script;
}

// Runs a script that draws, and waits for it.
void draw(const fs::path& script, std::vector<std::string> words) {
  words.insert(words.begin(), script.string());
  ChildProcess process(words);
  process.input().reset();
  const auto end = process.wait(kLongestDrawing);
  if (!end)
    throw std::runtime_error(fmt::format("{}: still draws after {:.0f} s",
                                         script.string(), kLongestDrawing));
  if (end->status == 0 && end->signal == 0) return;
  throw std::runtime_error(fmt::format(
      "{}: {} (it needs Python 3 with matplotlib, python3-matplotlib in "
      "Debian){}",
      script.string(), end_words(*end), last_words(errors_of(process))));
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

void draw_figures(const FigureScript& drawn_by, const std::string& result,
                  const fs::path& directory) {
  const fs::path script = script_of(drawn_by);
  const fs::path json = directory / "result.json";
  write_text_file(json, result);
  draw(script, {json.string()});
}

void require_picture_name(const fs::path& path) {
  const std::string ending = path.extension().string();
  if (ending != ".png" && ending != ".svg")
    throw std::invalid_argument(fmt::format(
        "--picture {}: unknown kind of picture \"{}\"; expected a name that "
        "ends in .png or .svg",
        path.string(), ending));
}

void draw_plan(const std::string& result, const fs::path& path) {
  const fs::path script = script_of({"--picture", "scripts/plan_figure.py"});
  AtomicFile picture(path);
  // The result lies beside the picture only as long as it is drawn.
  fs::path name = path;
  AtomicFile json(name += ".json");
  json.file().write(std::as_bytes(std::span(result)));
  draw(script, {json.partial_path().string(), picture.partial_path().string(),
                path.extension().string().substr(1)});
  picture.publish();
}

}  // namespace beamgyro::internal
