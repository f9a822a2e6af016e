// SPDX-License-Identifier: MIT
#include "validation/qualification/qualification_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "config/config_node.h"
#include "config/document.h"
#include "config/file_error.h"
#include "config/suggestion.h"
#include "dataset/files/text_file.h"
#include "dataset/log/csv_file.h"
#include "dataset/set/manifest.h"
#include "sim/campaign/draw_plan_file.h"
#include "sim/scenario/scenario_file.h"
#include "validation/metrics/metric.h"

namespace beamgyro::internal {
namespace {

// Keys that a seed does not draw: the purposes of runs and their metrics rest
// on them. The seed itself is always drawn.
constexpr std::array<std::string_view, 7> kSameForAllSeeds = {
    "name",           "description", "device", "fidelity",
    "output_rate_Hz", "seed",        "noise"};

std::vector<std::string> dotted_parts(const std::string& key) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// Returns ", did you mean "X"?" or an empty text.
std::string did_you_mean(const std::string& met,
                         const std::vector<std::string>& known) {
  const std::string near = suggestion(met, known);
  return near.empty() ? "" : fmt::format(", did you mean \"{}\"?", near);
}

std::vector<std::string> purpose_names() {
  std::vector<std::string> names;
  for (int k = 0; k <= static_cast<int>(RunPurpose::kVibration); ++k)
    names.emplace_back(purpose_name(static_cast<RunPurpose>(k)));
  return names;
}

class QualificationReader {
 public:
  explicit QualificationReader(const std::filesystem::path& file)
      : document_(ConfigDocument::read(file)),
        root_(document_.root()),
        folder_(file.parent_path()) {}

  Qualification read() {
    result_.name = root_.text("name");
    result_.description = root_.text_or("description", "");
    result_.text = document_.text();
    result_.files.push_back({document_.path(), document_.text()});
    for (const ConfigTable& table : root_.tables("run")) {
      result_.runs.push_back(read_run(table));
      const std::string purpose = table.choice("purpose", purpose_names());
      result_.runs.back().purpose = *purpose_of(purpose);
      read_start(table, result_.runs.back());
    }
    if (result_.runs.empty())
      root_.fail("run", "there is none; expected at least one [[run]]");
    for (const ConfigTable& table : root_.tables("training")) {
      const bool is_held_out = table.flag_or("held_out", false);
      const bool is_turning = table.flag_or("scale_factor", false);
      if (is_held_out && is_turning)
        table.fail("scale_factor",
                   "a run that is held out is not fitted; expected one of "
                   "held_out and scale_factor");
      (is_held_out  ? result_.held_out
       : is_turning ? result_.turning
                    : result_.training)
          .push_back(read_run(table));
    }
    if (result_.training.empty() &&
        !(result_.held_out.empty() && result_.turning.empty()))
      root_.fail("training",
                 "every run is held out or for the scale factor; expected one "
                 "that is trained on");
    if (const auto table = root_.optional_table("metrics"))
      for (const std::string& key : table->keys()) read_metric(*table, key);
    document_.reject_unknown_keys();
    return std::move(result_);
  }

 private:
  QualificationRun read_run(const ConfigTable& table) {
    QualificationRun run;
    run.name = table.text("name");
    if (!is_run_name(run.name))
      table.fail("name", fmt::format("\"{}\": expected a letter a-z, then "
                                     "letters, digits or _",
                                     printable(run.name)));
    if (!places_.emplace(run.name, table.place("name")).second)
      table.fail("name",
                 fmt::format("\"{}\": another run has this name", run.name));
    read_scenario_of(table, run);
    require_own_seed(table, run);
    read_vary(table, run);
    return run;
  }

  static void read_start(const ConfigTable& table, QualificationRun& run) {
    run.from = table.number_or("from_s", 0, non_negative());
    if (run.from >= run.scenario.duration)
      table.fail("from_s", fmt::format("{:g} s is not before the end of the "
                                       "run, duration_s = {:g}",
                                       run.from, run.scenario.duration));
  }

  void read_scenario_of(const ConfigTable& table, QualificationRun& run) {
    const std::filesystem::path path = folder_ / table.text("scenario");
    if (!std::filesystem::is_regular_file(status_of(path)))
      table.fail("scenario",
                 fmt::format("there is no file {}; expected one, named "
                             "relative to the qualification",
                             path.string()));
    Overrides overrides;
    if (const auto changes = table.optional_table("overrides"))
      for (const std::string& key : changes->keys())
        overrides.add(dotted_parts(key), changes->value(key),
                      changes->place(key));
    const ConfigDocument document = ConfigDocument::read(path, overrides);
    run.scenario = read_scenario(document);
    document.reject_unknown_keys();
    if (!overrides.all_used()) reject_unused(table, overrides);
    run.scenario_text = document.text();
    run.overrides_text = overrides.text();
    run.document = document.settled();
    add_file(path, document.text());
    add_profiles(document);
  }

  void read_vary(const ConfigTable& table, QualificationRun& run) {
    const DrawnFile file{*run.document, [this](const ConfigDocument& drawn) {
                           read_scenario(drawn, &result_.profiles);
                           add_profiles(drawn);
                         }};
    const ConfigTable vary = table.table_or_empty("vary");
    for (const std::string& key : vary.keys()) {
      if (std::ranges::count(kSameForAllSeeds, key.substr(0, key.find('.'))) >
          0)
        vary.fail(key, key == "seed"
                           ? "is always drawn; expected other keys"
                           : "is the same for all seeds; write it into "
                             "overrides");
      add_draw(read_draw(vary, key, key, file), run.name, run.vary, streams_);
    }
    check_medians(run.vary, file);
  }

  [[noreturn]] static void reject_unused(const ConfigTable& table,
                                         const Overrides& overrides) {
    const ConfigTable changes = table.table("overrides");
    const std::vector<std::string> asked = overrides.known_keys();
    for (const std::string& key : changes.keys())
      if (std::ranges::count(asked, key) == 0)
        changes.fail(key, fmt::format("the scenario takes no such key{}",
                                      did_you_mean(key, asked)));
    table.fail("overrides",
               "a key is not used together with the others of the scenario");
  }

  void require_own_seed(const ConfigTable& table, const QualificationRun& run) {
    if (!run.scenario.noise_enabled) return;
    const auto [other, is_new] = seeds_.emplace(run.scenario.seed, run.name);
    if (is_new) return;
    table.fail(
        "name",
        fmt::format("\"{}\" has the seed {} of \"{}\", so that both would have "
                    "the same noise; expected another in overrides = {{ seed = "
                    "... }}",
                    run.name, run.scenario.seed, other->second));
  }

  void read_metric(const ConfigTable& table, const std::string& key) {
    const Metric* metric = find_metric(key);
    if (metric == nullptr) {
      std::vector<std::string> known;
      for (const Metric& one : metrics()) known.emplace_back(one.name);
      table.fail(key, fmt::format("there is no such metric{}",
                                  did_you_mean(key, known)));
    }
    std::vector<std::string> names = table.texts(key);
    for (std::size_t k = 0; k < names.size(); ++k)
      require_readable(*metric, names[k], table.place(key, k));
    result_.metric_runs.emplace(key, std::move(names));
  }

  void require_readable(const Metric& metric, const std::string& name,
                        const std::string& place) const {
    const auto run =
        std::ranges::find(result_.runs, name, &QualificationRun::name);
    if (run == result_.runs.end()) {
      std::vector<std::string> known;
      for (const QualificationRun& one : result_.runs)
        known.push_back(one.name);
      throw std::invalid_argument(
          fmt::format("{}: there is no [[run]] of the name \"{}\"{}", place,
                      printable(name), did_you_mean(name, known)));
    }
    if (std::ranges::count(metric.reads, run->purpose) > 0) return;
    std::vector<std::string_view> read;
    for (const RunPurpose purpose : metric.reads)
      read.push_back(purpose_name(purpose));
    throw std::invalid_argument(fmt::format(
        "{}: \"{}\" has the purpose {}; the metric reads runs of {}", place,
        name, purpose_name(run->purpose), fmt::join(read, ", ")));
  }

  void add_profiles(const ConfigDocument& document) {
    for (const std::filesystem::path& profile : profile_files(document)) {
      const std::string text = read_text_file(profile);
      add_file(profile, text);
      result_.profiles.try_emplace(profile.lexically_normal(),
                                   parse_csv(text, profile.filename()));
    }
  }

  // Several runs may read one file, which has to stay the same meanwhile.
  void add_file(const std::filesystem::path& path, const std::string& text) {
    const auto known =
        std::ranges::find(result_.files, path, &SourceText::path);
    if (known == result_.files.end())
      result_.files.push_back({path, text});
    else if (known->text != text)
      throw std::runtime_error(path.string() + ": changed while it was read");
  }

  ConfigDocument document_;
  const ConfigTable& root_;
  std::filesystem::path folder_;
  Qualification result_;
  std::map<std::string, std::string> places_;   // of the names of runs
  std::map<std::uint64_t, std::string> seeds_;  // names by seed
  std::set<std::uint32_t> streams_;             // of what a seed draws
};

}  // namespace

Qualification read_qualification(const std::filesystem::path& file) {
  return QualificationReader(file).read();
}

}  // namespace beamgyro::internal
