// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/schedule_options.h"
#include "cli/terminal.h"
#include "compensation/compensator/compensator_file.h"
#include "config/units.h"
#include "dataset/files/atomic_file.h"
#include "planning/chamber_view.h"
#include "planning/planner.h"
#include "planning/schedule_file.h"
#include "planning/soak_length.h"
#include "planning/soak_model.h"
#include "planning/soak_noise.h"
#include "report/plan_report.h"
#include "sim/device/device.h"
#include "sim/scenario/simulation_input.h"
#include "sim/signal/noise.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShippedDevice = "scenarios/devices/nominal.toml";
constexpr std::size_t kLeastTable = 7;  // soaks in the table of trade-offs

struct PlanArguments {
  std::string population, output, json, picture, device, range, chamber;
  std::optional<long> soaks, hold;
  std::optional<double> hours, residual, ramp, start;
  std::vector<std::string> candidates;
  bool bias_only = false;
};

void check_goal(const PlanArguments& arguments) {
  const int goals = (arguments.soaks ? 1 : 0) + (arguments.hours ? 1 : 0) +
                    (arguments.residual ? 1 : 0);
  if (goals != 1)
    throw std::invalid_argument(fmt::format(
        "{} goals given; expected one of --soaks N, --hours H and --residual "
        "R",
        goals));
}

Population read_population_of(const PlanArguments& arguments) {
  Compensator compensator = read_compensator(arguments.population);
  if (!compensator.population)
    throw std::invalid_argument(fmt::format(
        "{}: kind: \"{}\"; expected a population, which `beamgyro train` "
        "writes with scenarios/population/population.toml",
        arguments.population, kind_name(compensator.bias)));
  return std::move(*compensator.population);
}

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
  return load_device(device, {}).device;
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

// What the population knows, in whole kelvins of the chamber.
TemperatureRange known_range(const Population& population,
                             const ChamberView& view) {
  const auto [lowest, highest] = population.range();
  return {std::ceil(view.chamber_temperature(lowest - kReach)),
          std::floor(view.chamber_temperature(highest + kReach))};
}

TemperatureRange chamber_of(const PlanArguments& arguments,
                            const TemperatureRange& range) {
  if (arguments.chamber.empty()) return range;
  const TemperatureRange chamber =
      temperature_range("--chamber", arguments.chamber);
  if (chamber.lowest > range.lowest || chamber.highest < range.highest)
    throw std::invalid_argument(fmt::format(
        "--chamber {}: narrower than the range {:g}:{:g}; expected a chamber "
        "that reaches both ends, or a narrower --range",
        arguments.chamber, range.lowest, range.highest));
  return chamber;
}

// Flicker is seen by a soak as the floor of its Allan deviation, white noise by
// the fewest rows that a soak has.
SlowNoise slow_noise(const NoiseParameters& noise) {
  const double flicker = std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi) *
                         noise.bias_instability;
  const double white =
      noise.angle_random_walk / std::sqrt(60.0 * kLeastSteadyRows);
  return {noise.turn_on / kDegree, noise.rate_random_walk / kDegree,
          std::hypot(flicker, white) / kDegree};
}

// What the device's thermal model says at the ends of the range and right after
// power-on, and its noise.
SoakBehaviour behaviour_of(const PlanArguments& arguments, const Device& device,
                           const TemperatureRange& range,
                           const ChamberTime& time) {
  SoakBehaviour found;
  found.rows = slowest_rows(
      device.thermal,
      {range.lowest, std::clamp(time.start, range.lowest, range.highest),
       range.highest},
      time, kSteady);
  found.noise = slow_noise(device.noise);
  if (arguments.hold) found.minutes = static_cast<std::size_t>(*arguments.hold);
  return found;
}

// A goal counts as met within the digits that are printed.
SoakPlan chosen_plan(const PlanArguments& arguments, const Planner& planner) {
  constexpr double kHourDigits = 0.005, kResidualDigits = 0.0005;
  if (arguments.hours)
    return planner.within_hours(*arguments.hours + kHourDigits);
  if (arguments.residual)
    return planner.within_residual(*arguments.residual + kResidualDigits);
  const auto count = static_cast<std::size_t>(*arguments.soaks);
  if (count > planner.most_soaks())
    throw std::invalid_argument(fmt::format(
        "--soaks {}: soaks are {:g} K apart or more; expected 1 to {}", count,
        kLeastDistance, planner.most_soaks()));
  return planner.with_soaks(count);
}

std::vector<std::string> observed_of(const SoakModel& model, bool bias_only) {
  std::vector<std::string> names = {"bias"};
  if (!bias_only)
    for (const Input& channel : model.population().channels)
      names.push_back(input_name(channel));
  return names;
}

PlanResult result_of(const PlanArguments& arguments, const SoakModel& model,
                     const Planner& planner, const TemperatureRange& chamber) {
  PlanResult result;
  result.chosen = chosen_plan(arguments, planner);
  const std::size_t count = result.chosen.temperatures.size();
  result.even = planner.even(count);
  for (const std::vector<double>& soaks :
       candidate_schedules(arguments.candidates, chamber))
    result.candidates.push_back(planner.judged(soaks));
  result.trade_offs = planner.trade_offs(
      std::min(std::max(count, kLeastTable), planner.most_soaks()));
  result.time = planner.time_of(result.chosen);
  result.range = model.range();
  result.observed = observed_of(model, arguments.bias_only);
  result.devices = model.population().devices;
  result.basis = forecast_basis(model.population());
  if (result.basis == ForecastBasis::kGaussian)
    result.warnings.push_back(fmt::format(
        "{}: has no coefficients of devices, as an older program wrote it; the "
        "residuals are forecast for normally distributed devices, which real "
        "ones are not; train it again",
        arguments.population));
  return result;
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
  check_goal(arguments);
  check_outputs(arguments);
  Population population = read_population_of(arguments);
  const Device device = read_device_of(arguments);
  if (device.thermal.oven)
    throw std::invalid_argument(fmt::format(
        "{}: has an oven, which holds the beam at one temperature whatever the "
        "chamber does; expected a device without",
        arguments.device));
  const ChamberView view(device.thermal, device.temperature_sensor.offset);
  const TemperatureRange range =
      arguments.range.empty() ? known_range(population, view)
                              : temperature_range("--range", arguments.range);
  const TemperatureRange chamber = chamber_of(arguments, range);
  const SoakModel model(
      std::move(population),
      [&](const Eigen::ArrayXd& T) { return view.sensor_temperatures(T); },
      {.range = range, .bias_only = arguments.bias_only});
  ChamberTime time;
  time.start = arguments.start.value_or(time.start);
  time.ramp = arguments.ramp.value_or(time.ramp);
  const Planner planner(model, chamber, time,
                        behaviour_of(arguments, device, range, time));
  const PlanResult result = result_of(arguments, model, planner, chamber);
  const std::string json = plan_json(result).dump(2) + "\n";
  if (!arguments.picture.empty()) draw_plan(json, arguments.picture);
  if (!arguments.output.empty())
    write_text_file(arguments.output,
                    schedule_text(result.chosen.temperatures, result.time,
                                  device_name(arguments)));
  if (!arguments.json.empty()) write_text_file(arguments.json, json);
  for (const std::string& warning : result.warnings) print_warning(warning);
  print_result(plan_text(result));
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
                  arguments.hold, {1, kLongestSoak});
  command.number({"--start", "DEGC",
                  "Temperature at which chamber and device begin", "25"},
                 arguments.start, kChamberTemperatures);
}

void add_plan_options(Command& command, PlanArguments& arguments) {
  command.argument(
      {"POPULATION.json", "", "Population that `train` learned from a set"},
      arguments.population);
  command.reads({{FileKind::kCompensator}});
  command.group("Goal, one of them");
  command.integer({"--soaks", "N", "Number of soaks", "no such goal"},
                  arguments.soaks, {1, static_cast<long>(kMostSoaks)});
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
