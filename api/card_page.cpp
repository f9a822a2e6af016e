// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "api/card_facts.h"

namespace beamgyro::internal {
namespace {

std::string counted(const CardFacts& facts, const char* part) {
  return fmt::format("{} {}", std::ranges::count(facts.parts, part), part);
}

std::string range_text(const std::optional<CardRange>& range,
                       const char* unit) {
  if (!range) return "not stored";
  return fmt::format("{:.3g} to {:.3g} {}", range->lowest, range->highest,
                     unit);
}

bool is_at_rest(const CardRun& run) {
  return run.true_rate && run.true_rate->lowest == 0 &&
         run.true_rate->highest == 0;
}

std::string runs_text(const CardFacts& facts) {
  std::string text =
      "| run | fidelity | samples | Hz | temperature | true rate |\n"
      "|---|---|---|---|---|---|\n";
  for (const CardRun& run : facts.runs) {
    const std::vector<double>& time = run.head.time;
    const double rate = time.size() > 1 ? 1 / (time[1] - time[0]) : 0;
    fmt::format_to(
        std::back_inserter(text), "| {} | {} | {} | {:.4g} | {} | {} |\n",
        run.head.run, run.head.fidelity, time.size(), rate,
        range_text(run.temperature, "degC"),
        is_at_rest(run) ? "at rest" : range_text(run.true_rate, "deg/s"));
  }
  std::size_t most = 0;
  for (const CardRun& run : facts.runs) most = std::max(most, run.looked_at);
  return text + fmt::format(
                    "\nTemperatures and rates are those of powered samples of "
                    "the first {} devices.\n",
                    most);
}

std::string variables_text(const CardFacts& facts) {
  std::string text =
      "| run | variable | unit | role | meaning |\n|---|---|---|---|---|\n";
  for (const CardRun& run : facts.runs)
    for (const SetVariable& variable : run.head.variables)
      fmt::format_to(std::back_inserter(text), "| {} | {} | {} | {} | {} |\n",
                     run.head.run, variable.name, variable.units,
                     role_name(variable.role), variable.long_name);
  return text;
}

std::string drawn_text(const CardFacts& facts) {
  if (facts.parameters.empty())
    return "No number differs between the devices, or there are too many "
           "devices to list.\n";
  std::string text =
      "| number | unit | smallest | largest |\n|---|---|---|---|\n";
  for (const CardParameter& parameter : facts.parameters) {
    std::vector<double> values;
    for (const std::optional<double>& value : parameter.values)
      if (value) values.push_back(*value);
    if (values.empty()) continue;
    const auto [lowest, highest] = std::ranges::minmax(values);
    fmt::format_to(std::back_inserter(text), "| {} | {} | {:.4g} | {:.4g} |\n",
                   parameter.name, parameter.about.units, lowest, highest);
  }
  return text;
}

bool has_variable(const CardFacts& facts, std::string_view name) {
  return std::ranges::any_of(facts.runs, [&](const CardRun& run) {
    return std::ranges::find(run.head.variables, name, &SetVariable::name) !=
           run.head.variables.end();
  });
}

// Bias is known where both rates are stored.
std::string teaches(const CardFacts& facts) {
  std::string text;
  if (has_variable(facts, "true_rate"))
    text +=
        "- How the bias of devices of this population follows temperature and "
        "the other measured\n  signals, within the temperatures below: the "
        "true rate is stored.\n";
  if (facts.head.devices > 1 && !facts.parameters.empty())
    text +=
        "- What devices have in common and how they differ, for the numbers "
        "drawn below.\n";
  if (facts.runs.size() > 1)
    text += "- Whether what was learned in one run holds in another.\n";
  return text +
         "- Methods: the set is whole, split by device, and can be made "
         "again byte for byte.\n";
}

std::string does_not_teach(const CardFacts& facts) {
  std::string text =
      "- Anything about a product: no sample was measured. Physics that the "
      "simulator leaves out is\n  missing from all of them. A compensator "
      "trained here needs a test on real units.\n"
      "- Devices outside the drawn ranges, and temperatures outside those "
      "below.\n";
  if (std::ranges::all_of(facts.runs, is_at_rest))
    text +=
        "- Scale factor, linearity, or whether a compensator leaves rates "
        "alone: every run is at rest.\n  A method that answers 0 would look "
        "perfect.\n";
  if (facts.runs.size() == 1)
    text +=
        "- Whether it holds under other conditions: all devices go through "
        "one run.\n";
  if (!has_variable(facts, "true_hysteresis") &&
      !has_variable(facts, "true_fictive_temperature"))
    text += "- Hysteresis and memory: the devices have none.\n";
  if (!has_variable(facts, "true_spurious_bias"))
    text +=
        "- Spurious resonances, which leave bumps in the bias of real units: "
        "the devices have none.\n";
  if (std::ranges::all_of(facts.runs, [](const CardRun& run) {
        return run.head.fidelity == "quasistatic";
      }))
    text += "- Start-up and fast changes: the runs are quasi-static.\n";
  if (std::ranges::count(facts.parts, "test") == 0)
    text += "- How good a method is on new devices: no device is for tests.\n";
  return text;
}

std::string failures_text(const CardFacts& facts) {
  const auto failed = std::ranges::count_if(
      facts.failures, [](const std::string& text) { return !text.empty(); });
  std::string text = failed == 0
                         ? "Every device has values in every run.\n"
                         : fmt::format(
                               "{} of {} devices have no values in some run; "
                               "manifest.jsonl has the reasons.\n",
                               failed, facts.failures.size());
  for (const std::string& caution : facts.cautions) text += caution + "\n";
  return text;
}

std::string or_missing(const std::string& text) {
  return text.empty() ? "not stated" : text;
}

}  // namespace

std::string readme_text(const CardFacts& facts, const SetCardOptions& options) {
  std::uint64_t bytes = 0;
  for (const CardFile& file : facts.files) bytes += file.bytes;
  return fmt::format(
      "# {}\n\n{} virtual vibrating-beam piezo gyros with thermal drift: {}, "
      "{}, "
      "{}. {}\n\n"
      "- Made by beamgyro {} ({}) from the seed {}; simulated, not measured.\n"
      "- {} files, {:.4g} MB, each with its SHA-256 in `croissant.json`.\n"
      "- Licence: {}. Page: {}. By: {}. Published: {}. Version {}.\n\n"
      "## What it can teach\n\n{}\n"
      "## What it cannot teach\n\n{}\n"
      "## Runs\n\n{}\n"
      "## Variables\n\n{}\n"
      "Signals that come in steps are counts with `scale_factor` and "
      "`add_offset`, as netCDF has them.\n`status` has a bit for samples "
      "without power (1), saturated (2) and without lock (4).\n\n"
      "## Numbers drawn for each device\n\n{}\n"
      "## What is missing\n\n{}\n"
      "## Reading and checking\n\n"
      "`RUN.nc` shows all devices of a run as one dataset of HDF5 or netCDF. "
      "`beamgyro verify .` compares\nevery byte with the manifest; `source/` "
      "has all that `beamgyro generate` read.\n",
      facts.name, facts.head.devices, counted(facts, "train"),
      counted(facts, "validation"), counted(facts, "test"), facts.description,
      facts.head.program_version, facts.head.git_revision, facts.head.seed,
      facts.files.size(), static_cast<double>(bytes) / 1e6,
      or_missing(options.license), or_missing(options.url),
      or_missing(options.creator), or_missing(options.date), options.version,
      teaches(facts), does_not_teach(facts), runs_text(facts),
      variables_text(facts), drawn_text(facts), failures_text(facts));
}

}  // namespace beamgyro::internal
