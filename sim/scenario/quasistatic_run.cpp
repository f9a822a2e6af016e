// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "config/units.h"
#include "sim/dynamics/mechanical_noise.h"
#include "sim/dynamics/spurious_bias.h"
#include "sim/dynamics/static_map.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/filtered_motion.h"
#include "sim/scenario/material_limits.h"
#include "sim/scenario/motion.h"
#include "sim/scenario/run_stability.h"
#include "sim/scenario/run_temperatures.h"
#include "sim/scenario/sensing_noise.h"
#include "sim/scenario/simulation.h"
#include "sim/signal/readout.h"
#include "sim/thermal/thermal_trajectory.h"

namespace beamgyro::internal {
namespace {

using Samples = std::vector<double>;

// electronics_at() of temperatures near each other: the phase from that of the
// nearest of a grid, by series that are exact to roundoff.
class Board {
 public:
  explicit Board(const TrimmedGyro& gyro)
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

void write_sample(const Electronics& board, const BeamSignal& at_rate,
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

// The rate [rad/s] that the output filter shows, sample by sample, and its
// largest magnitude in the run. That takes a pass over the whole run, which is
// kept unless the run is long.
class FilteredRate {
 public:
  FilteredRate(const Motion& motion, const OutputFilter& filter,
               const SampleGrid& grid)
      : stream_(filter.responses(motion.axes()[kRateZ], grid.rate)) {
    if (motion.rate_is_zero()) return;
    constexpr std::size_t kLong = std::size_t{1} << 18;  // 2 MB
    const bool is_kept = grid.count <= kLong;
    SampleStream first_pass =
        filter.responses(motion.axes()[kRateZ], grid.rate);
    Samples rate;
    for (std::size_t k = 0; k < grid.count; k += rate.size()) {
      rate.resize(is_kept ? grid.count
                          : std::min(kBlockSamples, grid.count - k));
      first_pass(rate);
      for (const double r : rate) fastest_ = std::max(fastest_, std::abs(r));
    }
    if (is_kept) kept_ = std::move(rate);
  }

  double fastest() const { return fastest_; }

  /// The next samples, as many as `rate` has.
  void next(Samples& rate) {
    if (kept_.empty()) return stream_(rate);
    std::copy_n(kept_.begin() + static_cast<std::ptrdiff_t>(taken_),
                rate.size(), rate.begin());
    taken_ += rate.size();
  }

 private:
  SampleStream stream_;
  double fastest_ = 0;
  Samples kept_;
  std::size_t taken_ = 0;
};

std::optional<SpuriousBias> spurious_bias_of(const TrimmedGyro& gyro) {
  if (gyro.device.spurious_modes.empty()) return std::nullopt;
  return std::optional<SpuriousBias>(std::in_place, gyro);
}

// Response to the rate alone, from a table over all temperatures and rates of
// the run.
class RateResponse {
 public:
  /// `beam` is the range of the beam's temperature.
  RateResponse(const TrimmedGyro& gyro, const Motion& motion,
               const TemperatureSpan& beam, const MemoryTrajectory* memory,
               const SampleGrid& grid)
      : board_(gyro),
        filter_(gyro.device.readout.corner_frequency),
        filtered_(motion, filter_, grid),
        map_(map_of(gyro, beam, memory, filtered_.fastest())),
        spurious_(spurious_bias_of(gyro)) {}

  void operator()(RunSamples& samples) {
    const Samples& beam = samples.temperature[kBeam];
    rate_.resize(beam.size());
    filtered_.next(rate_);
    std::array<StaticMap::Signals, 256> signals;
    for (std::size_t k = 0; k < rate_.size(); k += signals.size()) {
      const std::size_t count = std::min(signals.size(), rate_.size() - k);
      map_.sample(
          std::span(beam).subspan(k, count), std::span(rate_).subspan(k, count),
          part_of(samples.memory, k, count), std::span(signals).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        const Electronics board = board_.at(samples.temperature[kBoard][k + i]);
        write_sample(board, signals[i].at_rate, signals[i].at_rest, k + i,
                     samples);
        if (!spurious_) continue;
        samples.spurious_bias[k + i] = spurious_->of(
            signals[i].at_rest, signals[i].without_spurious, board);
      }
    }
  }

 private:
  static StaticMap map_of(const TrimmedGyro& gyro, const TemperatureSpan& range,
                          const MemoryTrajectory* memory, double fastest) {
    if (memory == nullptr) return {gyro, range.low, range.high, fastest};
    return {
        gyro, range.low, range.high, fastest,
        [memory](double low, double high) { return memory->range(low, high); }};
  }
  static std::span<const MemoryState> part_of(
      const std::vector<MemoryState>& memory, std::size_t k,
      std::size_t count) {
    if (memory.empty()) return {};
    return std::span(memory).subspan(k, count);
  }

  Board board_;
  OutputFilter filter_;
  FilteredRate filtered_;
  StaticMap map_;
  std::optional<SpuriousBias> spurious_;
  Samples rate_;
};

// Response with cross rates and accelerations, or to more than the beam's
// temperature: the exact solution for every sample, with the motion of the case
// behind the output filter.
class MotionResponse {
 public:
  MotionResponse(const TrimmedGyro& gyro, const Motion& motion,
                 double output_rate)
      : gyro_(gyro),
        board_(gyro),
        motion_(gyro, motion, output_rate),
        spurious_(spurious_bias_of(gyro)) {}

  void operator()(RunSamples& samples) {
    motion_.next(samples.time.size());
    for (std::size_t k = 0; k < samples.time.size(); ++k) {
      try {
        write(k, samples);
      } catch (const SimulationFailure& error) {
        throw SimulationFailure(fmt::format(
            "at {:g} s, with the beam at {:.2f} degC: {}", samples.time[k],
            samples.temperature[kBeam][k] - kZeroCelsius, error.what()));
      }
    }
  }

 private:
  void write(std::size_t k, RunSamples& samples) {
    const SpuriousTemperatures temperatures = {
        samples.temperature[kBeam][k], samples.temperature[kHousing][k]};
    const MemoryState memory =
        samples.memory.empty() ? MemoryState{} : samples.memory[k];
    const ModalParameters modal = modal_at(gyro_, temperatures, memory);
    CaseMotion motion = motion_.at(k);
    const BeamSignal at_rate = beam_signal(gyro_, modal, motion, path_);
    Complex at_rest = at_rate.demodulated;
    if (motion.z != 0) {
      motion.z = 0;
      at_rest =
          beam_signal(gyro_, modal, motion, path_, at_rate.drive_frequency)
              .demodulated;
    }
    const Electronics board = board_.at(samples.temperature[kBoard][k]);
    write_sample(board, at_rate, at_rest, k, samples);
    if (!spurious_) return;
    motion.z = 0;
    samples.spurious_bias[k] =
        spurious_->at(at_rest, temperatures, memory, motion, board);
  }

  const TrimmedGyro& gyro_;
  Board board_;
  LockPath path_;
  FilteredMotion motion_;
  std::optional<SpuriousBias> spurious_;
};

using StaticResponse = std::function<void(RunSamples& samples)>;

StaticResponse static_response(const TrimmedGyro& gyro, const Motion& motion,
                               const TemperatureSpan& beam,
                               const MemoryTrajectory* memory,
                               const SampleGrid& grid) {
  if (motion.has_other_axes() || needs_exact_solution(gyro))
    return MotionResponse(gyro, motion, grid.rate);
  if (memory == nullptr) return RateResponse(gyro, motion, beam, memory, grid);
  try {
    return RateResponse(gyro, motion, beam, memory, grid);
  } catch (const SimulationFailure&) {
    // No table spans the states; a failure at a sample is thrown there.
    return MotionResponse(gyro, motion, grid.rate);
  }
}

}  // namespace

void simulate_quasistatic(const ScenarioPlan& given, const TrimmedGyro& gyro,
                          const RunKey& key, const BlockSink& on_block,
                          std::size_t block_samples) {
  if (given.fidelity != Fidelity::kQuasistatic) {
    throw std::invalid_argument(
        "fidelity: a scenario of another fidelity was given to the "
        "quasi-static run; expected \"quasistatic\"");
  }
  const ScenarioPlan scenario = with_aligned_borders(given);
  const SampleGrid grid = sample_grid(scenario);
  const Motion motion(scenario, gyro, key);
  const std::unique_ptr<MemoryTrajectory> memory =
      memory_at_start(scenario, gyro);
  const ThermalTrajectory temperatures(ThermalNetwork(gyro.device.thermal),
                                       thermal_load(scenario, gyro), grid,
                                       memory ? memory->sink() : ThermalSink{});
  if (memory) memory->finish();
  const MaterialLimits limits(scenario, gyro.device.thermal);
  const TemperatureSpan beam = temperatures.range(kBeam);
  // No table reaches so far: the failure names the first sample.
  if (!MaterialLimits::stand(beam)) limits.check(temperatures, grid);
  const StaticResponse respond =
      static_response(gyro, motion, beam, memory.get(), grid);
  std::optional<RebalanceStability> stability = rebalance_stability(gyro);
  std::optional<SlowDriveNoise> drive_noise;
  if (has_channel_noise(scenario, gyro.device))
    drive_noise.emplace(scenario, gyro, beam, key);
  RunNoise noise = drive_noise ? drive_noise->rms() : RunNoise{};
  noise.sensing = sensing_angle_random_walk(gyro);
  RunRecorder recorder(scenario, gyro.device, key, noise);
  for (std::size_t k = 0; k < grid.count; k += block_samples) {
    const std::size_t count = std::min(block_samples, grid.count - k);
    RunSamples samples;
    samples.time = grid.times(k, count);
    for (Samples* column : {&samples.output, &samples.quadrature, &samples.bias,
                            &samples.drive_frequency, &samples.drive_voltage})
      column->resize(count);
    if (!gyro.device.spurious_modes.empty())
      samples.spurious_bias.resize(count);
    samples.locked.resize(count);
    for (std::size_t node = 0; node < kThermalNodeCount; ++node) {
      samples.temperature[node].resize(count);
      temperatures.sample(static_cast<ThermalNode>(node), k, samples.time,
                          samples.temperature[node]);
    }
    limits.check(samples.time, samples.temperature);
    if (memory) {
      samples.memory.resize(count);
      memory->sample(samples.time, samples.temperature[kBeam], samples.memory);
    }
    motion.sample(samples);
    respond(samples);
    if (stability) check_stability(scenario, samples, *stability);
    if (drive_noise) drive_noise->add_next(samples);
    on_block(recorder.block(std::move(samples)));
  }
}

}  // namespace beamgyro::internal
