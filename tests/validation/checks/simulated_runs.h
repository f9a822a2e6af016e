// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compensation/rows/run_source.h"
#include "dataset/recording/recording.h"
#include "validation/checks/checks.h"
#include "validation/evidence/evidence.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Runs of the nominal device at 10 Hz, simulated once: soaks, a rate table at
/// five temperatures, random rates and a rest.
struct SimulatedRun {
  std::string name;
  RunPurpose purpose;
  Recording recording;
};
const std::vector<SimulatedRun>& simulated_runs();

/// A sweep at other temperatures for training, at 1 Hz; `number` tells runs of
/// other seeds and temperatures.
TrainingRun training_sweep(int number);

/// Returns a compensator that the shipped model of that name trains on them.
const FittedCompensator& trained(const std::string& model);

/// A compensator under test whose answers are a function of the run.
class FunctionCompensator : public TestedCompensator {
 public:
  using Function = std::function<std::vector<double>(const Recording&)>;

  explicit FunctionCompensator(Function function)
      : function_(std::move(function)) {}

  std::vector<std::string> inputs() const override {
    return {"rate", "temperature"};
  }
  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override;

 private:
  Function function_;
};

/// Returns the runs with the answers of a compensator.
CheckedCompensator checked(const TestedCompensator& compensator);

/// Returns the names of the checks that failed.
std::vector<std::string> failed_checks(const CheckedCompensator& compensator);

/// Returns the answers as evidence; without a compensator the recorded rate.
Evidence evidence_of(const CheckedCompensator& compensator);
Evidence recorded_evidence();

}  // namespace beamgyro::internal
