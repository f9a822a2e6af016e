// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/soak_plan.h"
#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/schedule_options.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShippedDevice = "scenarios/devices/nominal.toml";

struct PlanArguments {
  std::string population, output, json, picture, device, range, chamber;
  std::optional<long> soaks, hold;
  std::optional<double> hours, residual, ramp, start;
  std::vector<std::string> candidates;
  bool bias_only = false;
};

fs::path device_of(const PlanArguments& arguments) {
  return arguments.device.empty() ? shipped_file(kShippedDevice)
                                  : fs::path(arguments.device);
}

Device read_device_of(const PlanArguments& arguments) {
  const fs::path device = device_of(arguments);
  if (device.empty())
    throw std::invalid_argument(
        fmt::format("{} is not beside this program; expected --device "
                    "DEVICE.toml",
                    kShippedDevice));
  return Device::read(device);
}

// The device as a scenario at `output` names it: by a path from there, unless
// the user or the program named it by an absolute one.
std::string device_name(const PlanArguments& arguments) {
  const fs::path device = device_of(arguments);
  if (device.is_absolute()) return device.string();
  return fs::proximate(fs::absolute(device),
                       fs::absolute(arguments.output).parent_path())
      .generic_string();
}

PlanOptions plan_options(const PlanArguments& arguments) {
  PlanOptions options;
  if (arguments.soaks)
    options.soaks = static_cast<std::size_t>(*arguments.soaks);
  options.hours = arguments.hours;
  options.residual_deg_per_s = arguments.residual;
  if (!arguments.range.empty())
    options.range_degC = temperature_range("--range", arguments.range);
  if (!arguments.chamber.empty())
    options.chamber_degC = temperature_range("--chamber", arguments.chamber);
  options.ramp_K_per_min = arguments.ramp;
  options.start_degC = arguments.start;
  if (arguments.hold)
    options.hold_min = static_cast<std::size_t>(*arguments.hold);
  options.bias_only = arguments.bias_only;
  if (!arguments.output.empty()) options.device_name = device_name(arguments);
  return options;
}

void check_outputs(const PlanArguments& arguments) {
  std::vector<fs::path> inputs = {arguments.population};
  if (!arguments.device.empty()) inputs.emplace_back(arguments.device);
  for (const std::string& word : arguments.candidates)
    if (fs::exists(word)) inputs.emplace_back(word);
  for (const std::string& output :
       {arguments.output, arguments.json, arguments.picture})
    if (!output.empty()) require_output(output, inputs);
  if (!arguments.output.empty()) require_ending(arguments.output, {".toml"});
  if (!arguments.json.empty()) require_json_name(arguments.json);
  if (!arguments.picture.empty())
    require_picture_name("--picture", arguments.picture);
}

int run_plan(const PlanArguments& arguments) {
  const PlanOptions options = plan_options(arguments);
  check_goal(options);
  check_outputs(arguments);
  const auto population = Compensator::read(arguments.population);
  const PlanStudy study(population, read_device_of(arguments), options);
  const SoakPlanResult result =
      study.result(candidate_schedules(arguments.candidates, study.chamber()));
  if (!arguments.picture.empty()) draw_plan(result.json, arguments.picture);
  if (!arguments.output.empty())
    write_text_file(arguments.output, result.schedule);
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
                 arguments.ramp, {0, 100, true, false});
  command.integer({"--hold", "MIN", "Length of a soak in whole minutes",
                   "the shortest that leaves at most 5 % more than the best"},
                  arguments.hold, {1});
  command.number({"--start", "DEGC",
                  "Temperature at which chamber and device begin", "25"},
                 arguments.start);
}

void add_plan_options(Command& command, PlanArguments& arguments) {
  command.argument(
      {"POPULATION.json", "", "Population that `train` learned from a set"},
      arguments.population);
  command.reads({{FileKind::kCompensator}});
  command.group("Goal, one of them");
  command.integer({"--soaks", "N", "Number of soaks", "no such goal"},
                  arguments.soaks, {1});
  command.number(
      {"--hours", "H", "Hours in the chamber at most", "no such goal"},
      arguments.hours, positive());
  command.number({"--residual", "R",
                  "Median over devices of the rms left, in deg/s, at most",
                  "no such goal"},
                 arguments.residual, positive());
  command.group("What is planned");
  command.text({"--range", "LOW:HIGH",
                "Temperatures of the chamber in degC over which the residual "
                "counts",
                "what the population knows"},
               arguments.range);
  command.flag({"--bias-only", "",
                "Plans for soaks that observe the bias, but no channel"},
               arguments.bias_only);
  command.texts({"--candidates", "T,T,...|FILE",
                 "Your own soaks in degC, to be compared; a file has a line "
                 "for each schedule. May be repeated",
                 "none"},
                arguments.candidates);
}

}  // namespace

void add_plan(CommandLine& program) {
  auto arguments = std::make_shared<PlanArguments>();
  Command& command = program.add(
      "plan", kCompensation,
      "Plans the soaks of a new device of a population: which temperatures "
      "leave the least residual for the time in the chamber");
  add_plan_options(command, *arguments);
  add_chamber_options(command, *arguments);
  command.group("Files to write");
  command.text(
      {"-o,--output", "SCHEDULE.toml",
       "Scenario that `run` executes, with the times for a chamber", "no file"},
      arguments->output);
  command.text({"--json", "FILE", "Writes all results to FILE", "no file"},
               arguments->json);
  command.text(
      {"--picture", "FILE.png|svg",
       "Draws residual against hours; needs Python with matplotlib", "no file"},
      arguments->picture);
  command.example("beamgyro plan population.json --soaks 3 -o soaks.toml",
                  "The best three soaks, as a scenario for `run`");
  command.example("beamgyro plan population.json --residual 0.1 --ramp 1",
                  "The fewest hours of a slow chamber for 0.1 deg/s");
  command.example(
      "beamgyro plan population.json --hours 3 --candidates=-40,5,50",
      "The best three hours, compared with soaks of your own");
  command.action([arguments] { return run_plan(*arguments); });
}

}  // namespace beamgyro::internal
