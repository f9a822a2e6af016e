// SPDX-License-Identifier: MIT
#include "cli/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "api/validation_members.h"
#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "config/range.h"
#include "report/verdict_report.h"

namespace beamgyro::internal {
namespace {

bool is_number(const std::string& word) {
  return !word.empty() &&
         std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

// Throws for numbers after the first of --device, which are no recordings.
void require_no_number(const ValidateArguments& arguments) {
  const auto number = std::ranges::find_if(arguments.runs, is_number);
  if (!arguments.device.empty() && number != arguments.runs.end())
    throw std::invalid_argument(fmt::format(
        "{0}: no recording; expected one number after each --device: --device "
        "{1} --device {0}",
        number->string(), arguments.device.back()));
}

// A word after --device is the number of a device of a set, or else a file.
void require_device_words(const ValidateArguments& arguments, bool is_of_set) {
  const auto is_wrong = [&](const std::string& word) {
    return is_number(word) != is_of_set;
  };
  const auto wrong = std::ranges::find_if(arguments.device, is_wrong);
  if (wrong != arguments.device.end())
    throw std::invalid_argument(fmt::format(
        "--device {}: {}", *wrong,
        is_of_set ? "of a set, a number is expected"
                  : "a number selects a device of a set, and there is none; "
                    "expected a set, or a device file (./5 for one of that "
                    "name)"));
  if (!is_of_set && arguments.device.size() > 1)
    throw std::invalid_argument(
        fmt::format("--device {}: a second device file; expected one",
                    arguments.device.back()));
}

std::filesystem::path shipped_qualification() {
  const std::filesystem::path file =
      shipped_file("scenarios/qualification.toml");
  if (file.empty())
    throw std::invalid_argument(
        "--qualification is missing, and this program has no scenarios beside "
        "it; expected --qualification QUALIFICATION.toml");
  return file;
}

void add_member(const ValidationMember& row, Command& command,
                ValidationOptions& options) {
  const OptionText text{"--" + std::string(row.option), std::string(row.value),
                        std::string(row.help), std::string(row.without)};
  command.group(std::string(row.heading));
  std::visit(
      [&](auto member) {
        auto& value = options.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::optional<double>>)
          command.number(text, value, positive());
        else if constexpr (std::is_same_v<Value, std::optional<std::uint32_t>>)
          command.integer(text, value, {1, 4000000000});
        else if constexpr (std::is_same_v<Value, bool>)
          command.flag(text, value);
        else if constexpr (std::is_same_v<Value, std::optional<std::uint64_t>>)
          command.seed(text, value);
        else if constexpr (std::is_same_v<Value, std::vector<std::string>>)
          command.list(text, value);
        else if constexpr (std::is_same_v<Value,
                                          std::vector<std::filesystem::path>>)
          command.texts(text, value);
        else if constexpr (std::is_same_v<Value,
                                          std::optional<std::filesystem::path>>)
          command.text(text, value);
        else
          throw std::logic_error("an option without words of its own");
      },
      row.member);
  if (row.kind) command.reads({{*row.kind}});
}

// Whether the arguments ask for no validation.
bool asks_for_none(const ValidateArguments& arguments) {
  return arguments.compensator.empty() && arguments.device.empty() &&
         std::ranges::none_of(validation_members(),
                              [&](const ValidationMember& row) {
                                return row.heading != kCodeHeading &&
                                       is_given(row, arguments.options);
                              }) &&
         arguments.json.empty() && arguments.junit.empty() &&
         arguments.trained.empty() && arguments.report.empty() &&
         arguments.figures.empty() && arguments.bundle.empty() &&
         !arguments.all_metrics && !arguments.lines;
}

void require_list_alone(const ValidateArguments& arguments) {
  if (asks_for_none(arguments) && arguments.check.empty() &&
      arguments.options.jobs == 0 && !arguments.limits.timeout &&
      !arguments.limits.memory && arguments.options.plugin_files.empty() &&
      !arguments.options.require_isolation && !arguments.runs_code)
    return;
  throw std::invalid_argument(
      "--list-metrics: judges nothing; expected no other argument");
}

void require_check_alone(const ValidateArguments& arguments) {
  if (asks_for_none(arguments)) return;
  throw std::invalid_argument(fmt::format(
      "--check {}: the bundle says what is validated; expected no more than "
      "--run-code, --jobs, --timeout-s, --memory-GiB, --plugin-files and "
      "--require-isolation beside it",
      arguments.check));
}

int validate_any(const ValidateArguments& arguments) {
  if (arguments.list_metrics) {
    require_list_alone(arguments);
    print_result(metric_list());
    return 0;
  }
  if (!arguments.check.empty()) {
    require_check_alone(arguments);
    return check_bundle(arguments);
  }
  if (arguments.runs_code)
    throw std::invalid_argument("--run-code is for --check DIR");
  if (arguments.compensator.empty())
    throw std::invalid_argument(
        "COMPENSATOR is missing; expected beamgyro validate COMPENSATOR "
        "RUN.h5..., beamgyro validate COMPENSATOR --device DEVICE.toml, or "
        "beamgyro validate --check DIR");
  if (arguments.lines && arguments.all_metrics)
    throw std::invalid_argument(
        "--lines and --all-metrics: expected one of them");
  require_limits_for_code(arguments.limits, arguments.compensator);
  return judge_compensator(arguments);
}

}  // namespace

ValidationOptions validation_options(const ValidateArguments& arguments) {
  require_no_number(arguments);
  const bool is_of_set = is_set(arguments.runs);
  require_device_words(arguments, is_of_set);
  ValidationOptions options = arguments.options;
  if (is_of_set) {
    options.set = Set::open(arguments.runs[0]);
    for (const std::string& word : arguments.device)
      options.devices.push_back(static_cast<std::uint32_t>(
          whole_number("--device", word, 0, kLastDevice)));
  } else {
    options.recordings = arguments.runs;
    if (!arguments.device.empty())
      options.device = Device::read(arguments.device[0]);
  }
  if (options.device && options.recordings.empty() && !options.qualification)
    options.qualification = shipped_qualification();
  return options;
}

void add_validate(CommandLine& program) {
  const auto [command, arguments] = program.add<ValidateArguments>(
      "validate", kCompensation,
      "Judges a compensator against the true rate; the status is 3 "
      "when it does not pass",
      validate_any);
  command.text({"COMPENSATOR", "",
                "Compensator: a file as written by train, a shared "
                "library, \"cmd:PROGRAM ARGS\", or with --device a model "
                "file that is trained first",
                "none, with --check"},
               arguments.compensator);
  command.reads({{FileKind::kCompensator, FileKind::kModel}});
  command.list({"RUN.h5...", "",
                "Recordings that training has not seen, or the directory "
                "of a set, whose test devices are judged",
                "none, with --device DEVICE.toml"},
               arguments.runs);
  command.reads({{FileKind::kRecording, FileKind::kSet}});
  command.texts({"--device", "DEVICE.toml|NUMBER",
                 "Device that the qualification is simulated with; of a set "
                 "the number of a device to judge, which may be repeated",
                 "the test devices of a set"},
                arguments.device);
  command.reads({{FileKind::kDevice}});
  for (const ValidationMember& row : validation_members())
    if (!row.option.empty()) add_member(row, command, arguments.options);
  command.group("What is written");
  command.text({"--json", "FILE", "Writes every figure to FILE", "no file"},
               arguments.json);
  command.text({"--junit", "FILE",
                "Writes limits, checks and verdict to FILE as JUnit XML, which "
                "servers of continuous integration read",
                "no file"},
               arguments.junit);
  command.text({"--save-trained", "FILE",
                "Of a model: writes the compensator that was trained and "
                "judged to FILE",
                "no file"},
               arguments.trained);
  command.text({"--report", "DIR", "Writes the page DIR/index.html", "no page"},
               arguments.report);
  command.text({"--figures", "DIR",
                "Writes a PNG of every figure of the page to DIR; needs Python "
                "with matplotlib",
                "no pictures"},
               arguments.figures);
  command.text({"--bundle", "DIR",
                "Writes inputs, result and report to the new directory DIR",
                "no bundle"},
               arguments.bundle);
  command.flag({"--all-metrics", "", "Prints every metric and check",
                "those that decide"},
               arguments.all_metrics);
  command.flag({"--lines", "",
                "Prints one line for each limit and check and for the verdict, "
                "with tabs between, in place of the tables",
                "tables"},
               arguments.lines);
  command.integer({"--jobs", "N", "Number of threads", "one per core"},
                  arguments.options.jobs, {1, 4096});
  command.group("A result made before");
  command.text({"--check", "DIR",
                "Makes the result of a bundle again and compares every byte; "
                "the status is 1 when one differs",
                "no check"},
               arguments.check);
  command.flag(
      {"--run-code", "", "Runs the library or the command of the bundle for it",
       "nothing of a bundle is run"},
      arguments.runs_code);
  command.flag({"--list-metrics", "",
                "Prints name, unit, clause of IEEE 1431, purposes of runs and "
                "definition of every metric, with tabs between, and does "
                "nothing else",
                "judges a compensator"},
               arguments.list_metrics);
  add_process_limits(command, arguments.limits);
  command.example("beamgyro validate cubic.json soak.h5 rates.h5",
                  "Prints what decides, and a verdict");
  command.example(
      "beamgyro validate cubic.json --device scenarios/devices/nominal.toml",
      "Simulates what the compensator has to stand");
}

}  // namespace beamgyro::internal
