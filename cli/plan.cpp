// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "api/soak_plan.h"
#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCandidates = 100;
constexpr const char* kShippedDevice = "scenarios/devices/nominal.toml";

struct PlanArguments {
  std::string population, output, json, picture, device, range, chamber;
  std::vector<std::string> candidates;
  PlanOptions options;
};

fs::path device_of(const PlanArguments& arguments) {
  if (!arguments.device.empty()) return arguments.device;
  const fs::path shipped = shipped_file(kShippedDevice);
  if (shipped.empty())
    throw std::invalid_argument(
        fmt::format("{} is not beside this program; expected --device "
                    "DEVICE.toml",
                    kShippedDevice));
  return shipped;
}

// Where the device is copied to, beside the schedule, so that both can go to
// another machine: one that is named by a path of this one. Nothing otherwise.
fs::path device_copy(const PlanArguments& arguments) {
  if (arguments.output.empty() || device_of(arguments).is_relative()) return {};
  const fs::path schedule = arguments.output;
  const fs::path copy =
      schedule.parent_path() / (schedule.stem().string() + "_device.toml");
  std::error_code absent;
  return fs::equivalent(copy, device_of(arguments), absent) ? fs::path() : copy;
}

// The device as the schedule names it: by a path from there.
std::string device_name(const PlanArguments& arguments) {
  if (const fs::path copy = device_copy(arguments); !copy.empty())
    return copy.filename().string();
  return fs::proximate(fs::absolute(device_of(arguments)),
                       fs::absolute(arguments.output).parent_path())
      .generic_string();
}

PlanOptions plan_options(const PlanArguments& arguments) {
  PlanOptions options = arguments.options;
  if (!arguments.range.empty())
    options.range_degC = temperature_range("--range", arguments.range);
  if (!arguments.chamber.empty())
    options.chamber_degC = temperature_range("--chamber", arguments.chamber);
  if (!arguments.output.empty()) options.device_name = device_name(arguments);
  return options;
}

void check_outputs(const PlanArguments& arguments) {
  std::vector<fs::path> inputs = {arguments.population};
  if (!arguments.device.empty()) inputs.emplace_back(arguments.device);
  for (const std::string& word : arguments.candidates)
    if (fs::exists(word)) inputs.emplace_back(word);
  for (const std::string& output : {arguments.output, arguments.picture})
    if (!output.empty()) require_output(output, inputs);
  if (!arguments.output.empty()) require_ending(arguments.output, {".toml"});
  if (const fs::path copy = device_copy(arguments); !copy.empty())
    require_output(copy.string(), inputs);
  require_json_output(arguments.json, inputs);
  if (!arguments.picture.empty())
    require_picture_name("--picture", arguments.picture);
}

NamedSoaks listed_soaks(const std::string& text, const std::string& where) {
  const std::vector<double> soaks = numbers_between(text, ',');
  if (soaks.empty())
    throw std::invalid_argument(fmt::format(
        "{}: \"{}\" is no list of numbers; expected temperatures in degC "
        "between commas, as in -40,5,50, or a file with such a list on each "
        "line",
        where, text));
  return {where, soaks};
}

// Each word is a list of temperatures between commas, or a file with such a
// list on each line, where # begins a comment.
std::vector<NamedSoaks> candidates_of(const std::vector<std::string>& words) {
  std::vector<NamedSoaks> found;
  for (const std::string& word : words) {
    if (!fs::is_regular_file(word)) {
      found.push_back(listed_soaks(word, "--candidates " + word));
      continue;
    }
    std::istringstream lines(read_text_file(word));
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      line.erase(std::min(line.find('#'), line.size()));
      if (line.find_first_not_of(" \t\r") == line.npos) continue;
      found.push_back(listed_soaks(line, fmt::format("{}:{}", word, number)));
    }
  }
  if (found.size() > kMostCandidates)
    throw std::invalid_argument(
        fmt::format("--candidates: {} schedules; expected {} at most",
                    found.size(), kMostCandidates));
  return found;
}

int run_plan(const PlanArguments& arguments) {
  const PlanOptions options = plan_options(arguments);
  check_goal(options);
  check_outputs(arguments);
  const auto population = Compensator::read(arguments.population);
  const Device device = Device::read(device_of(arguments));
  const SoakPlanResult result =
      planned(population, device, options, candidates_of(arguments.candidates));
  if (!arguments.picture.empty()) draw_plan(result.json, arguments.picture);
  if (!arguments.output.empty())
    write_text_file(arguments.output, result.schedule);
  if (const fs::path copy = device_copy(arguments); !copy.empty())
    write_text_file(copy, device.text());
  if (!arguments.json.empty()) write_text_file(arguments.json, result.json);
  for (const std::string& warning : result.warnings) print_warning(warning);
  print_result(result.text);
  return 0;
}

void add_chamber_options(Command& command, PlanArguments& arguments) {
  command.group("Device and chamber");
  command.text({"--device", "DEVICE.toml",
                "Device whose thermal model tells how warm the sensor is and "
                "how long a soak lasts, and whose noise soaks show",
                "the shipped nominal device"},
               arguments.device);
  command.reads({{FileKind::kDevice}});
  command.text({"--chamber", "LOW:HIGH",
                "Temperatures of the chamber in degC at which a soak may be",
                "the range"},
               arguments.chamber);
  command.number({"--ramp", "K/MIN", "Ramps between soaks", "2"},
                 arguments.options.ramp_K_per_min, {0, 100, true, false});
  command.integer({"--hold", "MIN", "Length of a soak in whole minutes",
                   "the shortest that leaves at most 5 % more than the best"},
                  arguments.options.hold_min, {1});
  command.number({"--start", "DEGC",
                  "Temperature at which chamber and device begin", "25"},
                 arguments.options.start_degC);
  command.flag({"--start-row", "",
                "Counts on the row that a ramp down from the start shows "
                "minutes after power-on, with device and chamber at the start "
                "temperature"},
               arguments.options.start_row);
}

void add_plan_options(Command& command, PlanArguments& arguments) {
  command.text(
      {"POPULATION.json", "", "Population that `train` learned from a set"},
      arguments.population);
  command.reads({{FileKind::kCompensator}});
  command.group("Goal, one of them");
  command.integer({"--soaks", "N", "Number of soaks", "no such goal"},
                  arguments.options.soaks, {1});
  command.number(
      {"--hours", "H", "Hours in the chamber at most", "no such goal"},
      arguments.options.hours, positive());
  command.number({"--residual", "R",
                  "Median over devices of the rms left, in deg/s, at most",
                  "no such goal"},
                 arguments.options.residual_deg_per_s, positive());
  command.group("What is planned");
  command.text({"--range", "LOW:HIGH",
                "Temperatures of the chamber in degC over which the residual "
                "counts",
                "what the population knows"},
               arguments.range);
  command.flag({"--bias-only", "",
                "Plans for soaks that observe the bias, but no channel"},
               arguments.options.bias_only);
  command.texts({"--candidates", "T,T,...|FILE",
                 "Your own soaks in degC, to be compared; a file has a line "
                 "for each schedule. May be repeated",
                 "none"},
                arguments.candidates);
}

}  // namespace

void add_plan(CommandLine& program) {
  const auto [command, arguments] = program.add<PlanArguments>(
      "plan", kCompensation,
      "Plans the soaks of a new device of a population: which temperatures "
      "leave the least residual for the time in the chamber",
      run_plan);
  add_plan_options(command, arguments);
  add_chamber_options(command, arguments);
  command.group("Files to write");
  command.text(
      {"-o,--output", "SCHEDULE.toml",
       "Scenario that `run` executes, with the times for a chamber", "no file"},
      arguments.output);
  command.text({"--json", "FILE", "Writes all results to FILE", "no file"},
               arguments.json);
  command.text(
      {"--picture", "FILE.png|svg",
       "Draws residual against hours; needs Python with matplotlib", "no file"},
      arguments.picture);
  command.example("beamgyro plan population.json --soaks 3 -o soaks.toml",
                  "The best three soaks, as a scenario for `run`");
  command.example("beamgyro plan population.json --residual 0.1 --ramp 1",
                  "The fewest hours of a slow chamber for 0.1 deg/s");
  command.example(
      "beamgyro plan population.json --hours 3 --candidates=-40,5,50",
      "The best three hours, compared with soaks of your own");
}

}  // namespace beamgyro::internal
