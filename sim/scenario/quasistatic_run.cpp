// SPDX-License-Identifier: MIT
#include "sim/scenario/quasistatic_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sim/dynamics/mechanical_noise.h"
#include "sim/dynamics/static_map.h"
#include "sim/scenario/run_temperatures.h"
#include "sim/scenario/square_acceleration.h"

namespace beamgyro {
namespace {

using Samples = std::vector<double>;

void show(const Gyro& gyro, const BeamSignal& at_rate, const Complex& at_rest,
          std::size_t k, RunSamples& samples) {
  const Electronics board =
      electronics_at(gyro, samples.temperature[kBoard][k]);
  const Output shown = board.output(at_rate.demodulated);
  samples.output[k] = shown.rate;
  samples.quadrature[k] = shown.quadrature;
  samples.bias[k] =
      at_rate.demodulated == at_rest ? shown.rate : board.output(at_rest).rate;
  samples.drive_frequency[k] = at_rate.drive_frequency / (2 * std::numbers::pi);
  samples.drive_voltage[k] = at_rate.drive_voltage;
  samples.locked[k] = at_rate.amplitude_locked;
}

// Rate alone: from a table over temperature and rate.
void show_rate(const Gyro& gyro, const Samples& rate, RunSamples& samples) {
  const Samples& beam = samples.temperature[kBeam];
  const auto [coldest, hottest] = std::minmax_element(beam.begin(), beam.end());
  double fastest = 0;
  for (const double r : rate) fastest = std::max(fastest, std::abs(r));
  const StaticMap map(gyro, *coldest, *hottest, fastest);
  for (std::size_t k = 0; k < rate.size(); ++k) {
    const StaticMap::Signals s = map.at(beam[k], rate[k]);
    show(gyro, s.at_rate, s.at_rest, k, samples);
  }
}

// Everything that moves the case, through the output filter.
struct FilteredMotion {
  Samples rate;
  std::array<Samples, 2> cross_rate;
  std::array<Samples, 3> acceleration;
  Samples square;  // of the acceleration, squared before it is filtered

  bool has_other_axes() const {
    const auto moved = [](const Samples& s) { return !s.empty(); };
    return std::any_of(cross_rate.begin(), cross_rate.end(), moved) ||
           std::any_of(acceleration.begin(), acceleration.end(), moved);
  }

  CaseMotion at(std::size_t k, const MountParameters& mount) const {
    const auto value = [k](const Samples& s) { return s.empty() ? 0.0 : s[k]; };
    CaseMotion motion;
    motion.x = value(cross_rate[0]);
    motion.y = value(cross_rate[1]);
    motion.z = rate[k];
    motion.in_phase =
        in_phase_rate(mount,
                      {value(acceleration[0]), value(acceleration[1]),
                       value(acceleration[2])},
                      value(square));
    return motion;
  }
};

// Fills the motion in `samples` and returns what the filter makes of it.
FilteredMotion filtered_motion(const Scenario& scenario, double corner,
                               const RunKey& key, RunSamples& samples) {
  const OutputFilter filter(corner);
  FilteredMotion filtered;
  const auto sampled = [&](const RateProfile& profile, RandomPurpose purpose,
                           Samples& values) {
    SampledRate s = sampled_rate(profile, filter, samples.time,
                                 scenario.output_rate, scenario.duration,
                                 scenario.seed, key.device, key.run, purpose);
    values = std::move(s.rate);
    return std::move(s.filtered);
  };
  filtered.rate =
      sampled(scenario.rate, RandomPurpose::kRateProfile, samples.rate);
  for (std::size_t i = 0; i < scenario.cross_rate.size(); ++i) {
    if (!moves(scenario.cross_rate[i])) continue;
    filtered.cross_rate[i] = sampled(scenario.cross_rate[i], kCrossPurposes[i],
                                     samples.cross_rate[i]);
  }
  for (std::size_t i = 0; i < scenario.acceleration.size(); ++i) {
    const RateProfile& profile = scenario.acceleration[i];
    if (!moves(profile)) continue;
    filtered.acceleration[i] =
        sampled(profile, kAccelerationPurposes[i], samples.acceleration[i]);
  }
  filtered.square = filtered_square_acceleration(scenario, corner, key);
  return filtered;
}

// Cross rates and accelerations: the exact solution for every sample.
void show_motion(const Gyro& gyro, const FilteredMotion& filtered,
                 RunSamples& samples) {
  for (std::size_t k = 0; k < samples.time.size(); ++k) {
    const ModalParameters modal =
        modal_parameters(gyro.device, gyro.beam, samples.temperature[kBeam][k],
                         gyro.stiffness_trim);
    CaseMotion motion = filtered.at(k, gyro.device.mount);
    const BeamSignal at_rate = beam_signal(gyro, modal, motion);
    motion.z = 0;
    show(gyro, at_rate, beam_signal(gyro, modal, motion).demodulated, k,
         samples);
  }
}

}  // namespace

Recording simulate_quasistatic(const Scenario& scenario, const Device& device,
                               const RunKey& key) {
  if (scenario.fidelity != Fidelity::kQuasistatic) {
    throw std::invalid_argument(
        "fidelity: a scenario of another fidelity was given to the "
        "quasi-static "
        "run; expected \"quasistatic\"");
  }
  const Gyro gyro = make_gyro(device);
  RunSamples samples;
  samples.time = sample_times(scenario);
  const std::size_t count = samples.time.size();
  for (Samples* column : {&samples.output, &samples.quadrature, &samples.bias,
                          &samples.drive_frequency, &samples.drive_voltage})
    column->resize(count);
  samples.locked.resize(count);
  samples.temperature =
      run_temperatures(scenario, gyro, samples.time).temperature;

  const FilteredMotion filtered =
      filtered_motion(scenario, device.readout.corner_frequency, key, samples);
  if (filtered.has_other_axes()) {
    show_motion(gyro, filtered, samples);
  } else {
    show_rate(gyro, filtered.rate, samples);
  }
  const double sensing_noise =
      low_frequency_noise(gyro, kCalibrationTemperature,
                          kCalibrationTemperature)
          .total() /
      std::numbers::sqrt2;
  return RunRecorder(scenario, device, key, sensing_noise)
      .block(std::move(samples));
}

}  // namespace beamgyro
