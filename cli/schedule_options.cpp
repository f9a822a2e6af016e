// SPDX-License-Identifier: MIT
#include "cli/schedule_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "dataset/files/text_file.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kMostCandidates = 100;

/// The numbers between `separator`, or nothing when one is no number.
std::vector<double> numbers_between(const std::string& text, char separator) {
  std::vector<double> values;
  const char* place = text.data();
  const char* const end = place + text.size();
  while (true) {
    while (place != end && *place == ' ') ++place;
    double value = 0;
    const auto [stop, error] = std::from_chars(place, end, value);
    if (error != std::errc()) return {};
    values.push_back(value);
    place = stop;
    while (place != end && (*place == ' ' || *place == '\r')) ++place;
    if (place == end) return values;
    if (*place != separator) return {};
    ++place;
  }
}

std::vector<double> schedule_of(const std::string& text,
                                const std::string& where,
                                const TemperatureRange& chamber) {
  const std::vector<double> soaks = numbers_between(text, ',');
  if (soaks.empty())
    throw std::invalid_argument(fmt::format(
        "{}: \"{}\" is no list of numbers; expected temperatures in degC "
        "between commas, as in -40,5,50, or a file with such a list on each "
        "line",
        where, text));
  return checked_soaks(soaks, where, chamber);
}

}  // namespace

std::pair<double, double> temperature_range(const std::string& option,
                                            const std::string& text) {
  const std::vector<double> ends = numbers_between(text, ':');
  if (ends.size() == 2) return {ends[0], ends[1]};
  throw std::invalid_argument(fmt::format(
      "{} {}: not a range; expected LOW:HIGH in degC", option, text));
}

std::vector<std::vector<double>> candidate_schedules(
    const std::vector<std::string>& words, const TemperatureRange& chamber) {
  std::vector<std::vector<double>> found;
  for (const std::string& word : words) {
    if (!std::filesystem::is_regular_file(word)) {
      found.push_back(schedule_of(word, "--candidates " + word, chamber));
      continue;
    }
    std::istringstream lines(read_text_file(word));
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      line.erase(std::min(line.find('#'), line.size()));
      if (line.find_first_not_of(" \t\r") == line.npos) continue;
      found.push_back(
          schedule_of(line, fmt::format("{}:{}", word, number), chamber));
    }
  }
  if (found.size() > kMostCandidates)
    throw std::invalid_argument(
        fmt::format("--candidates: {} schedules; expected {} at most",
                    found.size(), kMostCandidates));
  return found;
}

}  // namespace beamgyro::internal
