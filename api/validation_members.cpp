// SPDX-License-Identifier: MIT
#include "api/validation_members.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

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
    ValidationMember{"own_metrics", &Options::own_metrics,
                     kOnDevice | kOnRecordings, "", "own_metrics",
                     "own-metrics", "TABLE.csv",
                     "Shows and limits metrics of your own, a row each: "
                     "name,unit,before,after[,low,high]",
                     "none", kJudgedHeading, "own_metrics"},
    ValidationMember{"metrics", &Options::metrics, kOnDevice | kOnRecordings,
                     "", "metrics", "", "",
                     "Metrics of your own: a mapping of names to functions, or "
                     "to pairs of a function and its unit",
                     "none", kJudgedHeading, ""},
    ValidationMember{"workbench", &Options::workbench, kOnAny, "", "workbench",
                     "workbench", "COMPENSATOR.json",
                     "Also tells the difference from this compensator, that "
                     "firmware was exported from",
                     "no comparison", kJudgedHeading, "workbench",
                     FileKind::kCompensator},
    ValidationMember{"require_provenance", &Options::require_provenance, kOnAny,
                     "", "require_provenance", "require-provenance", "",
                     "Fails a compensator that does not say which runs it was "
                     "trained on",
                     "hold_out is not tested then", kJudgedHeading,
                     "require_provenance"},
    ValidationMember{"against", &Options::against, kOnDevice | kOnRecordings,
                     "", "against", "against", "COMPENSATOR.json",
                     "Also judges this compensator on the same runs and tells "
                     "which is better",
                     "no comparison", kJudgedHeading, "against",
                     FileKind::kCompensator},
    ValidationMember{
        "baseline_result", &Options::baseline_result, kOnDevice | kOnRecordings,
        "", "baseline_result", "baseline-result", "RESULT.json",
        "Fails where a metric, limit or check is worse than in "
        "this result of an earlier validation",
        "no comparison", kJudgedHeading, "baseline_result", FileKind::kResult},
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
    ValidationMember{
        "seed", &Options::seed, kOnDevice, "", "seed", "seed", "N|random",
        "Draws noise, order, lengths and temperatures of the runs, "
        "and the devices of a campaign, from this seed or a random "
        "one",
        "the qualification as its file says", kDeviceHeading, "seed"},
    ValidationMember{
        "seeds", &Options::seeds, kOnDevice, "", "seeds", "seeds", "N",
        "Judges with so many seeds in a row, the first of them that seed or "
        "else 1; the worst verdict counts",
        "one seed", kDeviceHeading, "seeds"},
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
         (options.recordings.empty() && options.recordings_in_memory.empty()
              ? 0U
              : kOnRecordings) |
         (options.set ? kOnSet : 0U);
}

void require_seeds(const ValidationOptions& options) {
  constexpr std::uint32_t kMostSeeds = 10'000;
  const auto named = [](const char* name, std::uint64_t value) {
    return NamedOption{name, std::to_string(value)};
  };
  if (options.seeds && (*options.seeds < 1 || *options.seeds > kMostSeeds))
    throw option_error("{}: out of range; expected a whole number from 1 to {}",
                       named("seeds", *options.seeds), kMostSeeds);
  const std::uint64_t most = kLargestSeed - (options.seeds.value_or(1) - 1);
  if (options.seed && *options.seed > most)
    throw option_error("{}: out of range; expected a whole number from 0 to {}",
                       named("seed", *options.seed), most);
  if (options.seeds && options.campaign)
    throw option_error("{} is for one device; expected no {} beside it",
                       named("seeds", *options.seeds), NamedOption{"campaign"});
}

// Figures of a table are of one compensator on one set of runs.
void require_own_metrics_alone(const ValidationOptions& options) {
  for (const auto& [given, name, others] :
       {std::tuple{options.own_metrics.has_value(), "own_metrics",
                   std::vector{"against", "seeds", "campaign"}},
        std::tuple{!options.metrics.empty(), "metrics",
                   std::vector{"campaign"}}})
    for (const char* other : others)
      if (given && is_given(member_named(other), options))
        throw option_error(
            "{} is for one compensator on one set of runs; expected no {} "
            "beside it",
            NamedOption{name}, NamedOption{other});
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
        if constexpr (std::is_same_v<Value, std::optional<std::uint64_t>>)
          return "seed";
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
        if constexpr (std::is_same_v<Value, std::vector<OwnMetric>>)
          return "functions";
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
  require_seeds(options);
  require_own_metrics_alone(options);
  std::vector<std::string> names;
  for (const std::filesystem::path& path : options.recordings)
    names.push_back(path.string());
  require_different_runs(names);
}

}  // namespace beamgyro::internal
