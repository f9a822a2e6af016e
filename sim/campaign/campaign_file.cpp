// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>

#include "config/option_message.h"
#include "dataset/set/manifest.h"
#include "sim/campaign/campaign.h"
#include "sim/campaign/campaign_files.h"
#include "sim/campaign/draw_plan_file.h"
#include "sim/campaign/spurious_population_file.h"

namespace beamgyro::internal {
namespace {

// Every device of a run has the same times and kind of file.
constexpr std::array<std::string_view, 8> kSameForAll = {
    "name",       "description",    "device", "fidelity",
    "duration_s", "output_rate_Hz", "seed",   "noise"};
constexpr std::string_view kAmbientOffset = "ambient_offset_K";
constexpr std::string_view kSplitStream = "split";

class CampaignReader {
 public:
  CampaignReader(const std::filesystem::path& file, std::optional<long> devices,
                 std::optional<std::uint64_t> seed)
      : document_(ConfigDocument::read(file)),
        root_(document_.root()),
        files_(document_, {}),
        devices_(devices),
        seed_(seed) {}

  /// Reads copies of every file and nothing else.
  CampaignReader(std::span<const SourceText> copies,
                 std::optional<long> devices)
      : document_(ConfigDocument::parse(copies.front().text,
                                        copies.front().path.string())),
        root_(document_.root()),
        files_(document_, copies),
        devices_(devices) {}

  CampaignPlan read() {
    taken_.insert(stream_number(kSplitStream));
    read_head();
    read_split();
    read_trims();
    read_device_file();
    read_tolerances();
    for (const ConfigTable& run : require_runs()) read_run(run);
    require_countable_files();
    read_output();
    read_sampling();
    document_.reject_unknown_keys();
    plan_.sources = files_.sources();
    plan_.profiles = files_.profiles();
    return std::move(plan_);
  }

 private:
  void read_head() {
    constexpr long kMostDevices = 4'000'000'000;
    plan_.name = root_.text("name");
    root_.text_or("description", "");
    plan_.text = document_.text();
    if (devices_ && (*devices_ < 1 || *devices_ > kMostDevices)) {
      throw option_error("{}: out of range; expected an integer in [1, {}]",
                         NamedOption{"devices", std::to_string(*devices_)},
                         kMostDevices);
    }
    const long devices = devices_
                             ? root_.integer_or("devices", 1, 1, kMostDevices)
                             : root_.integer("devices", 1, kMostDevices);
    plan_.devices = static_cast<std::uint32_t>(devices_.value_or(devices));
    plan_.devices_per_file = static_cast<std::uint32_t>(
        root_.integer_or("devices_per_file", 50, 1, 100'000));
    plan_.source.seed = static_cast<std::uint64_t>(
        root_.integer("seed", 0, std::numeric_limits<long>::max()));
    if (seed_) plan_.source.seed = *seed_;
  }

  void read_split() {
    std::vector<double> shares = {1, 0, 0};
    if (const auto split = root_.optional_table("split")) {
      const Range share{0, 1, false, false};
      shares = {split->number_or("train", 0, share),
                split->number_or("validation", 0, share),
                split->number_or("test", 0, share)};
      const double sum = shares[0] + shares[1] + shares[2];
      if (std::abs(sum - 1) > 1e-9) {
        root_.fail("split",
                   fmt::format("the shares sum to {:.9g}; expected 1", sum));
      }
    }
    plan_.split = discrete(shares);
  }

  void read_trims() {
    const ConfigTable trims = root_.table_or_empty("trims");
    plan_.trims = {trims.flag_or("quadrature", true),
                   trims.flag_or("offset", true),
                   trims.flag_or("scale_factor", true)};
  }

  void read_device_file() {
    const ConfigDocument& document = files_.named(root_, "device");
    plan_.device_document = document;
    plan_.base_device = files_.device(document, root_);
    document.reject_unknown_keys();
    const Trims& trims = plan_.trims;
    if (!trims.quadrature || !trims.offset || !trims.scale_factor)
      plan_.base_gyro = make_gyro(plan_.base_device);
  }

  void read_tolerances() {
    const ConfigTable tolerances = root_.table_or_empty("tolerances");
    const DrawnFile file{*plan_.device_document, [&](const ConfigDocument& d) {
                           files_.device(d, tolerances);
                         }};
    DrawPlan& plan = plan_.device_plan;
    for (const std::string& key : tolerances.keys()) {
      reject_untrimmed(tolerances, key);
      add_draw(read_draw(tolerances, key, key, file), "", plan, taken_);
    }
    if (root_.has("spurious_modes")) {
      add_draw(read_spurious_population(root_, make_gyro(plan_.base_device)),
               "", plan, taken_);
    }
    check_medians(plan, file);
    plan.groups = read_correlated(root_.tables("correlated"), plan);
  }

  void reject_untrimmed(const ConfigTable& tolerances, const std::string& key) {
    const auto check = [&](bool trimmed, std::string_view trim,
                           std::string_view trim_key) {
      if (trimmed || key != trim_key) return;
      tolerances.fail(key, fmt::format("follows from the other values with "
                                       "trims.{} = false; remove one of the "
                                       "two",
                                       trim));
    };
    check(plan_.trims.quadrature, "quadrature",
          "readout.quadrature_trim_deg_per_s");
    check(plan_.trims.offset, "offset", "readout.offset_trim_deg_per_s");
    check(plan_.trims.scale_factor, "scale_factor",
          "readout.scale_factor_error");
    if (!plan_.trims.scale_factor && key == "readout.mode") {
      tolerances.fail(key,
                      "the modes have no common scale factor to be built "
                      "with; remove this or trims.scale_factor = false");
    }
  }

  std::vector<ConfigTable> require_runs() {
    constexpr std::size_t kMostRuns = 1000;
    std::vector<ConfigTable> runs = root_.tables("run");
    if (runs.empty())
      root_.fail("run", "missing; expected at least one [[run]]");
    if (runs.size() > kMostRuns)
      root_.fail("run", fmt::format("{} runs; expected at most {}", runs.size(),
                                    kMostRuns));
    return runs;
  }

  // Files are numbered with 32 bits, and all of them are in one directory.
  void require_countable_files() {
    constexpr double kMostFiles = 1e7;
    const double files =
        std::ceil(static_cast<double>(plan_.devices) / plan_.devices_per_file) *
        static_cast<double>(plan_.runs.size());
    if (files <= kMostFiles) return;
    root_.fail(
        "devices_per_file",
        fmt::format("{} devices, {} a file, make {:.0f} files; expected "
                    "at most {:.0f}, so more devices a file",
                    plan_.devices, plan_.devices_per_file, files, kMostFiles));
  }

  std::string read_run_name(const ConfigTable& run) {
    const std::string name = run.text("name");
    if (!is_run_name(name)) {
      run.fail("name", fmt::format("\"{}\" is no name of files; expected a "
                                   "letter a-z, then letters, digits and '_', "
                                   "at most 200 in all",
                                   printable(name)));
    }
    for (const CampaignRun& other : plan_.runs) {
      if (other.name == name)
        run.fail("name", fmt::format("\"{}\" is the name of an earlier run; "
                                     "expected another",
                                     name));
    }
    return name;
  }

  void read_run(const ConfigTable& run) {
    const std::string name = read_run_name(run);
    const ConfigDocument& document = files_.named(run, "scenario");
    ScenarioPlan scenario = files_.scenario(document, run);
    document.reject_unknown_keys();
    scenario.seed = plan_.source.seed;
    DrawPlan plan = read_variations(run, name, document);
    const PerAxis<bool> moved =
        moved_axes(scenario, document, plan, files_.profiles());
    plan_.runs.push_back({name, document, scenario, std::move(plan), moved});
  }

  DrawPlan read_variations(const ConfigTable& run, const std::string& name,
                           const ConfigDocument& document) {
    const DrawnFile file{
        document, [&](const ConfigDocument& d) { files_.scenario(d, run); }};
    DrawPlan plan;
    const ConfigTable vary = run.table_or_empty("vary");
    for (const std::string& key : vary.keys()) {
      const std::string first = key.substr(0, key.find('.'));
      if (std::find(kSameForAll.begin(), kSameForAll.end(), first) !=
          kSameForAll.end()) {
        vary.fail(key,
                  "is the same for all devices of a set; write it into "
                  "the scenario");
      }
      add_draw(read_draw(vary, key, key, file), name, plan, taken_);
    }
    if (run.has(kAmbientOffset)) {
      add_draw(
          read_draw(run, std::string(kAmbientOffset), "ambient.offset_K", file),
          name, plan, taken_);
    }
    check_medians(plan, file);
    require_other_names(run, plan);
    return plan;
  }

  // A file holds the parameters of the device and those of the run.
  void require_other_names(const ConfigTable& run, const DrawPlan& plan) {
    for (const DeviceVariable& mine : plan.parameters) {
      for (const DeviceVariable& other : plan_.device_plan.parameters) {
        if (mine.name == other.name)
          run.fail("vary", fmt::format("two numbers are called {}; draw one of "
                                       "them",
                                       mine.name));
      }
    }
  }

  void read_output() {
    constexpr double kMostSteps = 1e8;  // more than any run has samples
    const ConfigTable output = root_.table_or_empty("output");
    CampaignOutput& result = plan_.output;
    if (output.has("variables")) {
      result.variables = output.texts("variables");
      result.variables_place = output.place("variables");
      if (result.variables.empty())
        output.fail("variables",
                    "[] is empty; expected names, or no key for "
                    "all variables");
    }
    result.double_precision =
        output.choice_or("precision", "float32", {"float32", "float64"}) ==
        "float64";
    result.compress = output.flag_or("compress", true);
    result.truth_rate = output.number_or("truth_rate_Hz", 0, positive());
    if (result.truth_rate == 0) return;
    for (const CampaignRun& run : plan_.runs) {
      const double rate = run.scenario.output_rate;
      const double step = rate / result.truth_rate;
      if (std::round(step) >= 1 && std::abs(step - std::round(step)) < 1e-9 &&
          step <= kMostSteps)
        continue;
      output.fail("truth_rate_Hz",
                  fmt::format("{} does not divide the output rate {} Hz of the "
                              "run {}; expected a rate that does, {:g} times "
                              "slower at most",
                              result.truth_rate, rate, run.name, kMostSteps));
    }
  }

  void read_sampling() {
    std::size_t dimensions = plan_.device_plan.parameters.size();
    for (CampaignRun& run : plan_.runs) {
      run.plan.first_dimension = dimensions;
      dimensions += run.plan.parameters.size();
    }
    if (root_.choice_or("sampling", "monte_carlo", {"monte_carlo", "sobol"}) !=
        "sobol") {
      return;
    }
    try {
      plan_.source.sobol.emplace(dimensions, plan_.source.seed);
    } catch (const std::invalid_argument& error) {
      root_.fail("sampling", error.what());
    }
  }

  ConfigDocument document_;
  const ConfigTable& root_;
  CampaignFiles files_;
  std::optional<long> devices_;
  std::optional<std::uint64_t> seed_;
  std::set<std::uint32_t> taken_;  // random streams
  CampaignPlan plan_;
};

}  // namespace

CampaignPlan CampaignPlan::read(const std::filesystem::path& file,
                                std::optional<long> devices,
                                std::optional<std::uint64_t> seed) {
  return CampaignReader(file, devices, seed).read();
}

CampaignPlan CampaignPlan::of_copies(std::span<const SourceText> copies,
                                     std::optional<long> devices) {
  return CampaignReader(copies, devices).read();
}

}  // namespace beamgyro::internal
