// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "config/document.h"
#include "dataset/files/text_file.h"
#include "dataset/log/log_import.h"
#include "dataset/netcdf/recording_file.h"

namespace beamgyro {
namespace {

struct ImportArguments {
  std::string log, map, output, axis;
};

std::string rows_text(const LogCounts& counts) {
  std::string text =
      fmt::format("{} rows read, {} kept\n", counts.rows, counts.kept);
  for (std::size_t i = 0; i < kDropReasons; ++i) {
    const DroppedRows& dropped = counts.dropped[i];
    if (dropped.rows == 0) continue;
    fmt::format_to(std::back_inserter(text),
                   "dropped      {} {}, the first in line {}\n", dropped.rows,
                   reason_name(static_cast<DropReason>(i)), dropped.first_line);
  }
  return text;
}

std::string sampling_text(const Recording& recording) {
  const Sampling sampling = sampling_of(recording);
  std::string text = fmt::format(
      "time         {:g} to {:g} s\n"
      "sampling     median step {:.6g} s ({:.6g} Hz), jitter {:.3g} s rms\n",
      recording.time.front(), recording.time.back(), sampling.median_step,
      1 / sampling.median_step, sampling.jitter);
  if (sampling.bursts > 1) {
    fmt::format_to(std::back_inserter(text),
                   "bursts       {}, the longest {:g} s; {} gaps, the longest "
                   "{:g} s\n",
                   sampling.bursts, sampling.longest_burst, sampling.bursts - 1,
                   sampling.longest_gap);
  }
  return text;
}

std::string range_text(const Recording& recording, const char* column,
                       const char* unit) {
  const ValueRange range = range_of(recording, column);
  if (range.samples == 0)
    return fmt::format("{:<12} unpowered throughout\n", column);
  if (range.smallest_step == 0)
    return fmt::format("{:<12} {:.6g} {} throughout\n", column, range.low,
                       unit);
  return fmt::format("{:<12} {:.6g} to {:.6g} {}, smallest step {:.3g}\n",
                     column, range.low, range.high, unit, range.smallest_step);
}

std::string status_text(const Recording& recording) {
  const auto samples = [&](StatusBit bit) {
    return std::count_if(recording.status.begin(), recording.status.end(),
                         [bit](unsigned status) { return status & bit; });
  };
  const auto unpowered = samples(kUnpowered);
  const auto saturated = samples(kOutputSaturated);
  const auto unlocked = samples(kLoopNotLocked);
  if (unpowered + saturated + unlocked == 0) return {};
  return fmt::format("status       {} unpowered, {} saturated, {} not locked\n",
                     unpowered, saturated, unlocked);
}

std::string report(const ImportedLog& log, const std::string& path) {
  const Recording& recording = log.recording;
  std::string text = path + ": " + rows_text(log.counts);
  text += sampling_text(recording);
  text += status_text(recording);
  text += range_text(recording, "rate", "deg/s");
  text += range_text(recording, "temperature", "degC");
  if (find_column(recording, "true_rate") != nullptr) {
    text += range_text(recording, "true_rate", "deg/s");
  } else {
    text +=
        "true_rate    not stated by the map: train and validate need one "
        "([true_rate] at_rest = true, or a column)\n";
  }
  return text;
}

int run_import(const ImportArguments& arguments) {
  require_recording_name(arguments.output);
  const LogMap map =
      read_log_map(ConfigDocument::read(arguments.map), arguments.axis);
  require_output(arguments.output, {arguments.log, arguments.map});
  std::optional<Progress> progress("importing " + arguments.log);
  ImportedLog log =
      import_log(read_text_file(arguments.log), arguments.log, map);
  Recording& recording = log.recording;
  recording.program_version = kProgramVersion;
  recording.git_revision = kGitRevision;
  if (!arguments.axis.empty())
    recording.overrides_text = fmt::format("axis={}\n", arguments.axis);
  const std::string text = report(log, arguments.log);
  write_recording(recording, arguments.output);
  progress.reset();
  print_result(text);
  return 0;
}

}  // namespace

void add_import(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = program.add_subcommand(
      "import", "Convert a log of a real gyro into a recording");
  command
      ->add_option(
          "log", arguments->log,
          "LOG.csv: delimiter-separated text with one sample in each row")
      ->required();
  command
      ->add_option("--map", arguments->map,
                   "MAP.toml, which states what the columns of the log mean")
      ->required();
  command->add_option("-o,--output", arguments->output, "RUN.h5 or RUN.csv")
      ->required();
  command->add_option("--axis", arguments->axis,
                      "x, y or z: which gyro to take if the map has several");
  command->callback([arguments, &action] {
    action = [arguments] { return run_import(*arguments); };
  });
}

}  // namespace beamgyro
