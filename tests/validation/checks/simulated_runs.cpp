// SPDX-License-Identifier: MIT
#include "tests/validation/checks/simulated_runs.h"

#include <fmt/format.h>

#include <map>

#include "compensation/training/train.h"
#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal {
namespace {

std::string constant_ambient(double celsius) {
  return fmt::format("[ambient]\nconstant_degC = {}\n", celsius);
}

Recording run_of(const std::string& ambient, const std::string& rate,
                 const std::string& duration, const std::string& output_rate,
                 std::uint64_t seed) {
  ScenarioPlan scenario = scenario_from(rate, ambient, duration, output_rate);
  scenario.seed = seed;
  return simulated(scenario, nominal_device());
}

/// Eleven rates over +-120 deg/s from 900 s on, up and back down, 20 s each.
std::string table_of_rates() {
  std::string steps = "[0, 0]";
  for (int k = 0; k < 22; ++k) {
    const int up = k < 11 ? k : 21 - k;
    steps += fmt::format(", [{}, {}]", 900 + 20 * k, 24 * up - 120);
  }
  return "[rate]\nsteps = [" + steps + "]\n";
}

std::vector<SimulatedRun> simulate_runs() {
  std::vector<SimulatedRun> runs;
  runs.push_back(
      {"soaks", RunPurpose::kSoak,
       run_of("[ambient.soaks]\ntemperatures_degC = [-36, -16, 4, 24, 44]\n"
              "hold_s = 600\nramp_K_per_min = 5\n",
              "", "3960", "10", 701)});
  for (const double celsius : {-38.0, -18.0, 2.0, 22.0, 42.0})
    runs.push_back({fmt::format("rates at {:g} degC", celsius),
                    RunPurpose::kRateTable,
                    run_of(constant_ambient(celsius), table_of_rates(), "1340",
                           "10", 702)});
  runs.push_back({"random rates", RunPurpose::kRandomRate,
                  run_of(constant_ambient(22),
                         "[rate]\nrandom = { rms_deg_per_s = 30, bandwidth_Hz "
                         "= 1 }\n",
                         "1200", "10", 703)});
  runs.push_back({"rest", RunPurpose::kRest,
                  run_of(constant_ambient(22), "", "1800", "10", 704)});
  return runs;
}

}  // namespace

const std::vector<SimulatedRun>& simulated_runs() {
  static const std::vector<SimulatedRun> kRuns = simulate_runs();
  return kRuns;
}

TrainingRun training_sweep(int number) {
  const std::string name = fmt::format("sweep {}", number);
  return {name, name,
          run_of(fmt::format("[ambient.soaks]\ntemperatures_degC = [{}, -30, "
                             "-20, -10, 0, 10, 20, 30, 40, 50]\nhold_s = 1200\n"
                             "ramp_K_per_min = 1\n",
                             -40 - number),
                 "", "17400", "1", 800 + static_cast<unsigned>(number))};
}

const FittedCompensator& trained(const std::string& model) {
  static std::map<std::string, FittedCompensator> compensators;
  const auto found = compensators.find(model);
  if (found != compensators.end()) return found->second;
  const ModelSpec spec = read_model(std::string(BEAMGYRO_SCENARIOS) +
                                    "/models/" + model + ".toml");
  return compensators[model] = train(spec, std::vector{training_sweep(0)},
                                     std::vector{training_sweep(1)}, 5)
                                   .compensator;
}

std::vector<Answer> FunctionCompensator::answers(
    const std::vector<const Recording*>& runs) const {
  std::vector<Answer> all;
  for (const Recording* run : runs) all.push_back({.rate = function_(*run)});
  return all;
}

CheckedCompensator checked(const TestedCompensator& compensator) {
  CheckedCompensator all;
  all.compensator = &compensator;
  for (const SimulatedRun& run : simulated_runs())
    all.runs.push_back({.name = run.name,
                        .purpose = run.purpose,
                        .recording = &run.recording,
                        .answer = compensator.answer(run.recording)});
  return all;
}

std::vector<std::string> failed_checks(const CheckedCompensator& compensator) {
  std::vector<std::string> names;
  for (const CheckResult& result : run_checks(compensator))
    if (result.outcome == CheckOutcome::kFailed) names.push_back(result.name);
  return names;
}

Evidence evidence_of(const CheckedCompensator& compensator) {
  Evidence evidence{.runs = {}, .full_scale = compensator.full_scale};
  for (const CheckedRun& run : compensator.runs)
    evidence.runs.push_back(
        {run.name, run.purpose, run.recording, run.answer.rate});
  return evidence;
}

Evidence recorded_evidence() {
  Evidence evidence;
  for (const SimulatedRun& run : simulated_runs())
    evidence.runs.push_back({run.name, run.purpose, &run.recording,
                             column_values(run.recording, "rate")});
  return evidence;
}

}  // namespace beamgyro::internal
