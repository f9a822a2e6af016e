// SPDX-License-Identifier: MIT
#include "sim/scenario/simulation.h"

#include "sim/scenario/carrier_run.h"
#include "sim/scenario/envelope_run.h"
#include "sim/scenario/quasistatic_run.h"

namespace beamgyro {

void simulate(const Scenario& scenario, const Gyro& gyro, const RunKey& key,
              const BlockSink& on_block) {
  switch (scenario.fidelity) {
    case Fidelity::kQuasistatic:
      return on_block(simulate_quasistatic(scenario, gyro, key));
    case Fidelity::kEnvelope:
      return simulate_envelope(scenario, gyro, key, on_block);
    case Fidelity::kCarrier:
      return simulate_carrier(scenario, gyro, key, on_block);
  }
}

Recording simulated(const Scenario& scenario, const Gyro& gyro,
                    const RunKey& key) {
  return joined([&](const BlockSink& on_block) {
    simulate(scenario, gyro, key, on_block);
  });
}

}  // namespace beamgyro
