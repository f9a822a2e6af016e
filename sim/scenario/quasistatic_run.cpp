// SPDX-License-Identifier: MIT
#include "sim/scenario/quasistatic_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "sim/dynamics/mechanical_noise.h"
#include "sim/dynamics/static_map.h"
#include "sim/scenario/run_temperatures.h"
#include "sim/scenario/square_acceleration.h"
#include "sim/signal/readout.h"

namespace beamgyro {
namespace {

using Samples = std::vector<double>;

// electronics_at() of temperatures near each other: the phase from that of the
// nearest of a grid, by series that are exact to roundoff.
class Board {
 public:
  explicit Board(const Gyro& gyro)
      : readout_(gyro.device.readout), offset_(gyro.offset) {}

  Electronics at(double temperature) {
    constexpr double kGrid = 0x1p-7;  // [rad]
    const double dT = temperature - kCalibrationTemperature;
    const double phase = (readout_.phase_tc + readout_.phase_tc2 * dT) * dT;
    const double nearest = kGrid * rounded(phase / kGrid);
    if (nearest != phase_) {
      phase_ = nearest;
      turn_ = std::polar(1.0, nearest);
    }
    const double d = phase - nearest, d2 = d * d;
    const double cos = 1 - d2 / 2 * (1 - d2 / 12);
    const double sin = d * (1 - d2 / 6 * (1 - d2 / 20));
    return {turn_ * Complex(cos, sin),
            offset_ + (readout_.offset_tc + readout_.offset_tc2 * dT) * dT};
  }

 private:
  const ReadoutParameters& readout_;
  double offset_;
  double phase_ = 0;
  Complex turn_ = 1;
};

void show(const Electronics& board, const BeamSignal& at_rate,
          const Complex& at_rest, std::size_t k, RunSamples& samples) {
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
  Board board(gyro);
  std::array<StaticMap::Signals, 256> block;
  for (std::size_t k = 0; k < rate.size(); k += block.size()) {
    const std::size_t count = std::min(block.size(), rate.size() - k);
    map.sample(std::span(beam).subspan(k, count),
               std::span(rate).subspan(k, count),
               std::span(block).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      show(board.at(samples.temperature[kBoard][k + i]), block[i].at_rate,
           block[i].at_rest, k + i, samples);
    }
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
  if (std::any_of(scenario.acceleration.begin(), scenario.acceleration.end(),
                  moves))
    filtered.square = filtered_square_acceleration(scenario, corner, key);
  return filtered;
}

// Cross rates and accelerations: the exact solution for every sample.
void show_motion(const Gyro& gyro, const FilteredMotion& filtered,
                 RunSamples& samples) {
  Board board(gyro);
  for (std::size_t k = 0; k < samples.time.size(); ++k) {
    const ModalParameters modal =
        modal_parameters(gyro.device, gyro.beam, samples.temperature[kBeam][k],
                         gyro.stiffness_trim);
    CaseMotion motion = filtered.at(k, gyro.device.mount);
    const BeamSignal at_rate = beam_signal(gyro, modal, motion);
    Complex at_rest = at_rate.demodulated;
    if (motion.z != 0) {
      motion.z = 0;
      at_rest =
          beam_signal(gyro, modal, motion, at_rate.drive_frequency).demodulated;
    }
    show(board.at(samples.temperature[kBoard][k]), at_rate, at_rest, k,
         samples);
  }
}

}  // namespace

Recording simulate_quasistatic(const Scenario& scenario, const Device& device,
                               const RunKey& key) {
  return simulate_quasistatic(scenario, make_gyro(device), key);
}

Recording simulate_quasistatic(const Scenario& scenario, const Gyro& gyro,
                               const RunKey& key) {
  if (scenario.fidelity != Fidelity::kQuasistatic) {
    throw std::invalid_argument(
        "fidelity: a scenario of another fidelity was given to the "
        "quasi-static "
        "run; expected \"quasistatic\"");
  }
  RunSamples samples;
  samples.time = sample_times(scenario);
  const std::size_t count = samples.time.size();
  for (Samples* column : {&samples.output, &samples.quadrature, &samples.bias,
                          &samples.drive_frequency, &samples.drive_voltage})
    column->resize(count);
  samples.locked.resize(count);
  samples.temperature =
      run_temperatures(scenario, gyro, samples.time).temperature;

  const FilteredMotion filtered = filtered_motion(
      scenario, gyro.device.readout.corner_frequency, key, samples);
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
  return RunRecorder(scenario, gyro.device, key, sensing_noise)
      .block(std::move(samples));
}

}  // namespace beamgyro
