// SPDX-License-Identifier: MIT
#include "include/beamgyro/variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "api/reported_progress.h"
#include "api/scenario_state.h"
#include "config/overrides.h"
#include "include/beamgyro/option_error.h"
#include "parallel/work_queue.h"
#include "sim/scenario/run_warnings.h"
#include "sim/scenario/simulation.h"

namespace beamgyro {
namespace {

using Strings = std::vector<std::string>;

/// The overrides of each run, counted with the last axis fastest.
class Combinations {
 public:
  explicit Combinations(const std::vector<VariedValues>& axes) : axes_(axes) {
    for (const VariedValues& axis : axes) {
      if (axis.empty())
        throw std::invalid_argument(
            "axes: one has no values; expected at least one");
      count_ *= axis.size();
    }
  }

  std::size_t count() const { return count_; }

  Strings of(std::size_t run) const {
    std::vector<const Strings*> values;
    for (auto axis = axes_.rbegin(); axis != axes_.rend(); ++axis) {
      values.push_back(&(*axis)[run % axis->size()]);
      run /= axis->size();
    }
    Strings all;
    for (auto value = values.rbegin(); value != values.rend(); ++value)
      all.insert(all.end(), (*value)->begin(), (*value)->end());
    return all;
  }

 private:
  const std::vector<VariedValues>& axes_;
  std::size_t count_ = 1;
};

// "beam.length_m = 0.04, seed = 3: "
std::string values_before(const Strings& overrides) {
  Strings words;
  for (const std::string& text : overrides) {
    const std::string_view key = internal::key_of_override(text);
    words.push_back(fmt::format("{} = {}", key, text.substr(key.size() + 1)));
  }
  return words.empty() ? "" : fmt::format("{}: ", fmt::join(words, ", "));
}

/// Simulates runs one after the other; one for each thread.
class VariantSimulator {
 public:
  explicit VariantSimulator(const internal::ScenarioState& base)
      : base_(base), input_(base.scenario, base.device, base.loaded.profiles) {
    for (const std::string& text : base.overrides)  // a device has been read
      if (internal::key_of_override(text) != "device")
        overrides_.push_back(text);
  }

  Recording run(const Strings& overrides, Strings& warnings) {
    input_.read(internal::merged_overrides(
        base_.device_overrides,
        internal::merged_overrides(overrides_, overrides)));
    if (input_.has_new_device()) gyro_.reset();
    if (!gyro_) gyro_.emplace(internal::make_gyro(input_.device()));
    internal::RunWarnings found(input_.scenario(), input_.device());
    Recording recording = internal::simulated(input_.scenario(), *gyro_);
    found.add(recording);
    warnings = found.texts();
    return recording;
  }

 private:
  const internal::ScenarioState& base_;
  internal::ScenarioVariants input_;
  std::optional<internal::TrimmedGyro> gyro_;
  Strings overrides_;
};

/// The values of all runs, of which each thread writes its own.
class VariantTable {
 public:
  VariantTable(const Recording& first, std::size_t runs,
               const Strings& variables)
      : columns_(first.columns.size()) {
    require_known(variables, first);
    table_.runs = runs;
    table_.time = first.time;
    const auto is_kept = [&](const std::string& name) {
      return variables.empty() || std::ranges::count(variables, name) > 0;
    };
    if (is_kept("status")) table_.status.resize(runs * first.time.size());
    for (const Column& column : first.columns) {
      if (!is_kept(column.name)) continue;
      table_.columns.push_back(column);
      table_.columns.back().values.assign(runs * first.time.size(), 0.0);
    }
  }

  void write(std::size_t run, const Recording& recording) {
    if (recording.columns.size() != columns_)
      throw std::invalid_argument(
          "has other variables than the first run; expected runs with the same "
          "ones");
    if (recording.time != table_.time)
      throw std::invalid_argument(
          "has other times than the first run; expected runs of one duration "
          "and rate");
    const auto place = static_cast<std::ptrdiff_t>(run * recording.time.size());
    if (!table_.status.empty())
      std::ranges::copy(recording.status, table_.status.begin() + place);
    for (Column& column : table_.columns) {
      const Column* values = find_column(recording, column.name);
      if (values == nullptr)
        throw std::invalid_argument(fmt::format(
            "has no {}, which the first run has; expected runs with the same "
            "variables",
            column.name));
      std::ranges::copy(values->values, column.values.begin() + place);
    }
  }

  VariantRuns taken() { return std::move(table_); }

 private:
  static void require_known(const Strings& variables, const Recording& first) {
    Strings known = {"status"};
    for (const Column& column : first.columns) known.push_back(column.name);
    for (const std::string& name : variables)
      if (std::ranges::count(known, name) == 0)
        throw std::invalid_argument(fmt::format(
            "variables: '{}': the runs have none; expected some of {}", name,
            fmt::join(known, ", ")));
  }

  std::size_t columns_;  // of every run
  VariantRuns table_;
};

/// Counts the warnings of the runs, in the order of the first run of each.
class WarningCounts {
 public:
  void add(std::size_t run, const Strings& texts) {
    for (const std::string& text : texts) {
      Count& count = counts_.try_emplace(text, Count{run, 0}).first->second;
      count.first = std::min(count.first, run);
      ++count.runs;
    }
  }

  std::vector<VariantWarning> all() const {
    std::vector<std::pair<std::size_t, VariantWarning>> found;
    for (const auto& [text, count] : counts_)
      found.push_back({count.first, {text, count.runs}});
    std::ranges::stable_sort(found, {},
                             &std::pair<std::size_t, VariantWarning>::first);
    std::vector<VariantWarning> warnings;
    for (auto& [first, warning] : found) warnings.push_back(std::move(warning));
    return warnings;
  }

 private:
  struct Count {
    std::size_t first, runs;
  };
  std::map<std::string, Count> counts_;
};

void require_no_device(const std::vector<VariedValues>& axes) {
  for (const VariedValues& axis : axes)
    for (const Strings& value : axis) internal::require_no_device_key(value);
}

// Calls `work`; its errors begin with the overrides of the run.
template <class Work>
void named(const Strings& overrides, const Work& work) {
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw OptionError(values_before(overrides), error);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(values_before(overrides) + error.what());
  }
}

}  // namespace

VariantRuns simulate_variants(const Scenario& scenario,
                              const std::vector<VariedValues>& axes,
                              const VariantOptions& options) {
  const Combinations combinations(axes);
  require_no_device(axes);
  const std::size_t count = combinations.count();
  const std::size_t threads =
      std::min<std::size_t>(internal::thread_count(options.jobs),
                            std::max<std::size_t>(count - 1, 1));
  std::vector<VariantSimulator> simulators(
      threads, VariantSimulator(scenario.content()));
  std::optional<VariantTable> table;
  WarningCounts warnings;
  std::mutex one_at_a_time;
  std::size_t done = 0;
  const auto add = [&](std::size_t run, std::size_t worker) {
    const Strings overrides = combinations.of(run);
    Strings texts;
    Recording recording;
    named(overrides, [&] {
      recording = simulators[worker].run(overrides, texts);
      if (table) table->write(run, recording);
    });
    if (!table) {
      table.emplace(recording, count, options.variables);
      table->write(run, recording);
    }
    const std::lock_guard lock(one_at_a_time);
    warnings.add(run, texts);
    internal::report(options.progress,
                     static_cast<double>(++done) / static_cast<double>(count));
  };
  add(0, 0);  // makes the table
  internal::for_each_task(
      count - 1, threads,
      [&](std::size_t run, std::size_t worker) { add(run + 1, worker); });
  VariantRuns runs = table->taken();
  runs.warnings = warnings.all();
  return runs;
}

}  // namespace beamgyro
