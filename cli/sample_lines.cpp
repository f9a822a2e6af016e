// SPDX-License-Identifier: MIT
#include "cli/sample_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "dataset/log/csv_file.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kInput = "standard input";

std::string too_long_words() {
  return fmt::format("a line of more than {} bytes", kLongestInputLine);
}

std::string cells_words(std::ptrdiff_t count) {
  return fmt::format("{} cell{}", count, count == 1 ? "" : "s");
}

}  // namespace

std::optional<Recording> SampleLines::sample(InputLine line) {
  ++number_;
  if (line.text.ends_with('\r')) line.text.pop_back();
  if (line.end != LineEnd::kTooLong &&
      line.text.find_first_not_of(" \t\r") == line.text.npos)
    return std::nullopt;
  if (header_.empty()) {
    take_names(line);
    return std::nullopt;
  }
  require_whole(line);
  Recording read = parsed(header_ + line.text + (has_status_ ? "\n" : ",0\n"));
  if (!(read.time[0] > time_))
    throw BadLine(LineFault::kTime,
                  fmt::format("{}: time {} does not follow {}; expected "
                              "times that rise",
                              place(), read.time[0], time_));
  time_ = read.time[0];
  return read;
}

void SampleLines::take_names(const InputLine& line) {
  if (line.end == LineEnd::kTooLong)
    throw std::invalid_argument(
        fmt::format("{}: {}; expected a line of names such as "
                    "time,rate,temperature",
                    place(), too_long_words()));
  const auto names = csv_names(line.text + "\n", kInput);
  const auto has = [&](std::string_view wanted) {
    return std::ranges::any_of(names, [&](const std::string& cell) {
      return column_name(cell).name == wanted;
    });
  };
  if (!has("time"))
    throw std::invalid_argument(
        fmt::format("{}: no column time; expected a line of names such as "
                    "time,rate,temperature",
                    place()));
  has_status_ = has("status");
  commas_ = std::ranges::count(line.text, ',');
  header_ = line.text + (has_status_ ? "\n" : ",status\n");
  require_names();
}

// What is wrong with names and units would be so at every sample. Reads one
// that is right whatever they are: of zeros, unpowered.
void SampleLines::require_names() const {
  std::string cells;
  for (const std::string& cell : csv_names(header_, kInput))
    cells += column_name(cell).name == "status" ? "1," : "0,";
  cells.back() = '\n';
  try {
    parse_recording_csv(header_ + cells, kInput);
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    const std::string file = fmt::format("{}: ", kInput);
    if (!message.starts_with(file)) throw;
    throw std::invalid_argument(
        fmt::format("{}: {}", place(), message.substr(file.size())));
  }
}

void SampleLines::require_whole(const InputLine& line) const {
  if (line.end == LineEnd::kTooLong)
    throw BadLine(LineFault::kTooLong,
                  fmt::format("{}: {}", place(), too_long_words()));
  if (line.end == LineEnd::kCutOff)
    throw BadLine(LineFault::kCutOff,
                  fmt::format("{}: the last line has no end and may be cut "
                              "off; expected a newline",
                              place()));
  // The reader would count the status that is added, too.
  if (const auto commas = std::ranges::count(line.text, ','); commas != commas_)
    throw BadLine(LineFault::kCells,
                  fmt::format("{}: {}; expected {} as in the line of names",
                              place(), cells_words(commas + 1), commas_ + 1));
}

// Messages of the reader speak of the second line, those of the recording of
// its only sample: "standard input: rate: sample 0 is nan ...".
Recording SampleLines::parsed(const std::string& text) const {
  try {
    return parse_recording_csv(text, kInput);
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    const std::string second = fmt::format("{}:2", kInput);
    if (message.starts_with(second))
      throw BadLine(LineFault::kNumber,
                    place() + message.substr(second.size()));
    const std::string file = fmt::format("{}: ", kInput);
    const std::string sample = ": sample 0 is ";
    const std::size_t at = message.find(sample);
    if (!message.starts_with(file) || at == message.npos)
      throw BadLine(LineFault::kValue, message);
    throw BadLine(LineFault::kValue,
                  fmt::format("{}: {} is {}", place(),
                              message.substr(file.size(), at - file.size()),
                              message.substr(at + sample.size())));
  }
}

std::string SampleLines::place() const {
  return fmt::format("{}:{}", kInput, number_);
}

}  // namespace beamgyro::internal
