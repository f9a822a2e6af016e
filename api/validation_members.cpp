// SPDX-License-Identifier: MIT
#include "api/validation_members.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "compensation/rows/run_source.h"
#include "config/option_message.h"

namespace beamgyro::internal {
namespace {

using Options = ValidationOptions;

constexpr std::string_view kDeviceHeading = "On a simulated device";
constexpr std::string_view kSetHeading = "Part of a set";
constexpr std::string_view kJudgedHeading = "What is asked for";

constexpr std::array kMembers{
    ValidationMember{"device", &Options::device, kOnDevice, "", "device", "",
                     "", "", "", kDeviceHeading, "device"},
    ValidationMember{"recordings", &Options::recordings, kOnRecordings, "",
                     "runs", "", "", "", "", "", "runs"},
    ValidationMember{"set", &Options::set, kOnSet, "", "set", "", "", "", "",
                     "", ""},
    ValidationMember{"devices", &Options::devices, kOnSet, "", "set_devices",
                     "", "", "Devices of the set, by number",
                     "the test devices", kSetHeading, ""},
    ValidationMember{"full_scale", &Options::full_scale, kOnRecordings | kOnSet,
                     "", "full_scale", "full-scale", "DEG_PER_S",
                     "Largest rate that is replayed",
                     "that of the recording's device file, or 150 for a log",
                     kJudgedHeading, "full_scale_deg_per_s"},
    ValidationMember{"specification", &Options::specification, kOnAny, "",
                     "spec", "spec", "SPEC.toml", "Limits that have to be met",
                     "better than a constant (specs/default.toml)",
                     kJudgedHeading, "specification", FileKind::kSpecification},
    ValidationMember{"workbench", &Options::workbench, kOnAny, "", "workbench",
                     "workbench", "COMPENSATOR.json",
                     "Also tells the difference from this compensator, that "
                     "firmware was exported from",
                     "no comparison", kJudgedHeading, "workbench",
                     FileKind::kCompensator},
    ValidationMember{"qualification", &Options::qualification, kOnDevice, "",
                     "qualification", "qualification", "FILE.toml",
                     "Runs that the device goes through",
                     "the shipped scenarios/qualification.toml", kDeviceHeading,
                     "qualification", FileKind::kQualification},
    ValidationMember{
        "campaign", &Options::campaign, kOnDevice, "", "campaign", "campaign",
        "CAMPAIGN.toml", "Also reports how many devices of a population pass",
        "one device alone", kDeviceHeading, "campaign", FileKind::kCampaign},
    ValidationMember{"campaign_devices", &Options::campaign_devices, kOnDevice,
                     "campaign", "devices", "devices", "N",
                     "Number of these devices", "that of the campaign",
                     kDeviceHeading, "devices"},
    ValidationMember{"runs", &Options::runs, kOnSet, "", "set_runs", "run",
                     "NAME", "Run to judge; may be repeated", "all runs",
                     kSetHeading, ""},
    ValidationMember{"plugin_files", &Options::plugin_files, kOnAny, "",
                     "plugin_files", "plugin-files", "PATH",
                     "File or folder that it may read; may be repeated",
                     "the system and the scripts that it names", kCodeHeading,
                     ""},
    ValidationMember{"require_isolation", &Options::require_isolation, kOnAny,
                     "", "require_isolation", "require-isolation", "",
                     "Judges no code that is not isolated",
                     "says so in the result", kCodeHeading, ""}};

unsigned subjects_of(const ValidationOptions& options) {
  return (options.device ? kOnDevice : 0U) |
         (options.recordings.empty() ? 0U : kOnRecordings) |
         (options.set ? kOnSet : 0U);
}

std::string words_of(unsigned subjects) {
  std::vector<std::string_view> words;
  if ((subjects & kOnDevice) != 0) words.emplace_back("a simulated device");
  if ((subjects & kOnRecordings) != 0) words.emplace_back("recordings");
  if ((subjects & kOnSet) != 0) words.emplace_back("a set");
  return fmt::format("{}", fmt::join(words, " or "));
}

}  // namespace

std::span<const ValidationMember> validation_members() { return kMembers; }

const ValidationMember& member_named(std::string_view name) {
  const auto* const row =
      std::ranges::find(kMembers, name, &ValidationMember::name);
  if (row == kMembers.end())
    throw std::logic_error(fmt::format("{}: not an option", name));
  return *row;
}

std::string_view type_name(const ValidationMember& row) {
  return std::visit(
      [&row](auto member) -> std::string_view {
        using Value = std::decay_t<decltype(ValidationOptions().*member)>;
        if constexpr (std::is_same_v<Value, std::optional<double>>)
          return "number";
        if constexpr (std::is_same_v<Value, std::optional<std::uint32_t>>)
          return "whole";
        if constexpr (std::is_same_v<Value, std::vector<std::uint32_t>>)
          return "wholes";
        if constexpr (std::is_same_v<Value, std::vector<std::string>>)
          return "texts";
        if constexpr (std::is_same_v<Value,
                                     std::optional<std::filesystem::path>>)
          return "file";
        if constexpr (std::is_same_v<Value, bool>) return "flag";
        if constexpr (std::is_same_v<Value, std::vector<std::filesystem::path>>)
          return row.option.empty() ? "" : "files";
        return "";
      },
      row.member);
}

std::vector<std::string_view> subject_names(const ValidationMember& row) {
  std::vector<std::string_view> names;
  if ((row.subjects & kOnDevice) != 0) names.emplace_back("device");
  if ((row.subjects & kOnRecordings) != 0) names.emplace_back("recordings");
  if ((row.subjects & kOnSet) != 0) names.emplace_back("set");
  return names;
}

bool is_given(const ValidationMember& row, const ValidationOptions& options) {
  return std::visit(
      [&options](auto member) {
        const auto& value = options.*member;
        if constexpr (std::is_same_v<decltype(value), const bool&>)
          return value;
        else if constexpr (requires { value.has_value(); })
          return value.has_value();
        else
          return !value.empty();
      },
      row.member);
}

void require_sound(const ValidationOptions& options) {
  const unsigned subject = subjects_of(options);
  if (subject == 0)
    throw option_error(
        "nothing to validate on; expected recordings, the directory of a set, "
        "or {}",
        NamedOption{"device", "DEVICE.toml"});
  if ((subject & (subject - 1)) != 0)
    throw option_error(
        "{} to validate on; expected one of them{}", words_of(subject),
        options.device ? ": of a set, a number selects devices" : "");
  for (const ValidationMember& row : kMembers) {
    if (!is_given(row, options)) continue;
    if ((row.subjects & subject) == 0)
      throw option_error("{} is for {}; this validation is on {}",
                         NamedOption{std::string(row.name)},
                         words_of(row.subjects), words_of(subject));
    for (const ValidationMember& other : kMembers)
      if (other.name == row.needs && !is_given(other, options))
        throw option_error("{} needs {}", NamedOption{std::string(row.name)},
                           NamedOption{std::string(row.needs)});
  }
  if (options.device && !options.qualification)
    throw std::invalid_argument(
        "qualification is missing; expected a qualification file, which says "
        "what the device goes through");
  std::vector<std::string> names;
  for (const std::filesystem::path& path : options.recordings)
    names.push_back(path.string());
  require_different_runs(names);
}

}  // namespace beamgyro::internal
