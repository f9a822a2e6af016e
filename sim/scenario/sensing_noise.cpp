// SPDX-License-Identifier: MIT
#include "sim/scenario/sensing_noise.h"

#include <cmath>

#include "sim/dynamics/loop_noise.h"
#include "sim/scenario/drive_lock.h"
#include "sim/scenario/random_purposes.h"

namespace beamgyro {

SensingNoise::SensingNoise(const Scenario& scenario, const Gyro& gyro,
                           const RunKey& key)
    : scenario_(scenario),
      gyro_(gyro),
      ode_(gyro, drive_heating(gyro)),
      key_(key) {}

void SensingNoise::add_next(RunSamples& samples) {
  for (std::size_t k = 0; k < samples.time.size(); ++k) {
    if (!powered_at(scenario_.powered, samples.time[k])) continue;
    const double beam = samples.temperature[kBeam][k];
    const double board = samples.temperature[kBoard][k];
    if (!noise_) {
      noise_.emplace(loop_noise(gyro_, ode_, beam, board),
                     1 / scenario_.output_rate,
                     RandomStream(scenario_.seed, key_.device, key_.run,
                                  kMechanicalNoiseStream));
      beam_ = beam, board_ = board;
    } else {
      if (std::abs(beam - beam_) > kNoiseRefresh ||
          std::abs(board - board_) > kNoiseRefresh) {
        noise_->refresh(loop_noise(gyro_, ode_, beam, board));
        beam_ = beam, board_ = board;
      }
      noise_->advance();
    }
    samples.output[k] += noise_->state()(kOutput2);
    samples.quadrature[k] -= noise_->state()(kOutput2 + 1);
  }
}

}  // namespace beamgyro
