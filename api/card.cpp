// SPDX-License-Identifier: MIT
#include "include/beamgyro/card.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <utility>

#include "api/card_facts.h"
#include "dataset/files/set_files.h"
#include "include/beamgyro/option_error.h"

namespace beamgyro {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const std::string& expected) {
  throw OptionError([=](const OptionSpelling& spelled) {
    return fmt::format("{}: expected {}", spelled(option, value), expected);
  });
}

bool is_printable(const std::string& text) {
  return std::ranges::none_of(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// YYYY-MM-DD of a month and a day that exist.
bool is_date(const std::string& text) {
  if (text.size() != 10) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i == 4 || i == 7
            ? text[i] != '-'
            : std::isdigit(static_cast<unsigned char>(text[i])) == 0)
      return false;
  const int month = std::stoi(text.substr(5, 2)),
            day = std::stoi(text.substr(8));
  return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

bool is_version(const std::string& text) {
  int dots = 0;
  bool after_digit = false;
  for (const char c : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit && (c != '.' || !after_digit)) return false;
    dots += c == '.';
    after_digit = digit;
  }
  return dots == 2 && after_digit;
}

void check(const SetCardOptions& options) {
  for (const auto& [name, value] : {std::pair{"license", &options.license},
                                    {"creator", &options.creator},
                                    {"url", &options.url}})
    if (!is_printable(*value))
      refuse(name, "", "a text without control characters");
  if (!options.url.empty() && !options.url.starts_with("https://") &&
      !options.url.starts_with("http://"))
    refuse("url", options.url, "an address that begins with https://");
  if (!options.date.empty() && !is_date(options.date))
    refuse("date", options.date, "a date as 2026-11-28");
  if (!is_version(options.version))
    refuse("version", options.version, "three numbers as 1.0.0");
}

std::vector<std::string> missing(const SetCardOptions& options,
                                 const Set& set) {
  std::vector<std::string> names;
  for (const auto& [name, value] : {std::pair{"license", &options.license},
                                    {"url", &options.url},
                                    {"creator", &options.creator},
                                    {"datePublished", &options.date}})
    if (value->empty()) names.emplace_back(name);
  std::vector<std::string> warnings;
  if (!names.empty())
    warnings.push_back(fmt::format(
        "{} has no {}, which Croissant 1.0 requires: state it, since no set "
        "knows it",
        internal::kCroissantName, fmt::join(names, ", ")));
  if (set.devices() > internal::kMostListedDevices)
    warnings.push_back(fmt::format(
        "{} has no table of its {} devices: there are more than {}",
        internal::kCroissantName, set.devices(), internal::kMostListedDevices));
  return warnings;
}

// Refuses to replace a page that somebody wrote by hand.
void require_own(const std::filesystem::path& directory) {
  constexpr std::array<std::pair<const char*, const char*>, 2> kMarks = {
      {{internal::kCroissantName, "http://mlcommons.org/croissant/1.0"},
       {internal::kReadmeName, "## What it cannot teach"}}};
  for (const auto& [name, mark] : kMarks)
    if (internal::find_in_set(directory, name) &&
        internal::read_set_file(directory, name).find(mark) ==
            std::string::npos)
      throw std::invalid_argument(
          fmt::format("{}: is there already and is no card of a set; expected "
                      "another name for it",
                      (directory / name).string()));
}

}  // namespace

SetCard card_of(const Set& set, const SetCardOptions& options) {
  check(options);
  const internal::CardFacts facts = internal::card_facts(set, options.progress);
  SetCard card;
  card.readme = internal::readme_text(facts, options);
  card.croissant = internal::croissant_text(facts, options, card.readme);
  card.warnings = missing(options, set);
  return card;
}

std::vector<std::string> write_card(const Set& set,
                                    const SetCardOptions& options) {
  require_own(set.directory());
  SetCard card = card_of(set, options);
  for (const auto& [name, text] :
       {std::pair{internal::kReadmeName, &card.readme},
        {internal::kCroissantName, &card.croissant}})
    internal::publish_file(set.directory(), name,
                           std::as_bytes(std::span(*text)));
  return std::move(card.warnings);
}

}  // namespace beamgyro
