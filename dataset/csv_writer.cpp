// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <stdexcept>
#include <string>

#include "dataset/atomic_file.h"
#include "dataset/csv_file.h"
#include "dataset/recording_defect.h"

namespace beamgyro {
namespace {

void append(double value, std::string& text) {
  if (value != value) {  // the sign of a NaN means nothing
    text += "nan";
    return;
  }
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

}  // namespace

void write_recording_csv(const Recording& recording,
                         const std::filesystem::path& path) {
  const std::string defect = recording_defect(recording);
  if (!defect.empty()) {
    throw std::runtime_error(
        fmt::format("{}: not written: {}", path.string(), defect));
  }
  const std::size_t status_at = status_position(recording);
  const std::vector<Column>& columns = recording.columns;
  std::string text = "time";
  for (std::size_t i = 0; i <= columns.size(); ++i) {
    if (i == status_at) text += ",status";
    if (i < columns.size()) text += ',' + columns[i].name;
  }
  text += '\n';
  for (std::size_t k = 0; k < recording.time.size(); ++k) {
    append(recording.time[k], text);
    for (std::size_t i = 0; i <= columns.size(); ++i) {
      if (i == status_at) text += ',' + std::to_string(recording.status[k]);
      if (i == columns.size()) break;
      text += ',';
      append(columns[i].values[k], text);
    }
    text += '\n';
  }
  write_text_file(path, text);
}

}  // namespace beamgyro
