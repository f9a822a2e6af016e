// SPDX-License-Identifier: MIT
#include "tests/validation/external/tested_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dataset/recording/signals.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {

Recording tested_run(double duration) {
  RecordedRun run;
  run.duration = duration;
  run.step = 0.01;
  run.true_rate = [](double t) { return 50.0 * std::sin(3.0 * t); };
  run.temperature = [](double t) { return 20.0 + 0.3 * t; };
  run.bias = [](double t) { return 0.01 * (20.0 + 0.3 * t); };
  run.powered = [](double t) { return t < 8.995 || t > 9.495; };
  return run.recording();
}

ProcessLimits test_limits() {
  ProcessLimits limits;
  limits.program = BEAMGYRO_PLUGIN_HOST;
  limits.stall = 2.0;
#ifdef BEAMGYRO_SANITIZED
  limits.memory = 0;
#endif
  return limits;
}

std::shared_ptr<const TestedCompensator> faulty_plugin(
    const std::string& fault) {
  return open_tested_compensator(
      std::string(BEAMGYRO_FAULTY_PLUGINS) + "/" + fault + ".so",
      test_limits());
}

SeenFault only_fault(const TestedCompensator& compensator,
                     const Recording& run) {
  const Answer answer = compensator.answer(run);
  EXPECT_EQ(answer.faults.size(), 1u);
  for (std::size_t k = 1; k < answer.faults.size(); ++k)
    ADD_FAILURE() << answer.faults[k].words;
  return answer.faults.empty() ? SeenFault{AnswerFault::kTooFew, 0, "none"}
                               : answer.faults[0];
}

}  // namespace beamgyro::internal
