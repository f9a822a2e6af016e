// SPDX-License-Identifier: MIT
#include "sim/scenario/envelope_run.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "sim/scenario/drive_lock.h"
#include "sim/scenario/loop_run.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// States that a sample needs.
const std::vector<Index> kStoredStates = {
    kFeedback2,         kFeedback2 + 1,     kPllIntegral,
    kAgcIntegral,       kOutput2,           kOutput2 + 1,
    kEnvelopeNodes + 0, kEnvelopeNodes + 1, kEnvelopeNodes + 2,
    kEnvelopeNodes + 3, kEnvelopeNodes + 4, kEnvelopeNodes + 5};
constexpr std::size_t kFirstNode = 6;

RunSamples samples_of_states(const std::vector<std::vector<double>>& c,
                             const LoopElectronics& loops,
                             const TrimmedGyro& gyro) {
  const std::size_t count = c[0].size();
  RunSamples s;
  s.output.resize(count);
  s.quadrature.resize(count);
  s.drive_frequency.resize(count);
  s.drive_voltage.resize(count);
  s.locked.resize(count);
  for (std::size_t node = 0; node < kThermalNodeCount; ++node)
    s.temperature[node] = c[kFirstNode + node];
  for (std::size_t k = 0; k < count; ++k) {
    const DriveSignals drive =
        drive_signals(loops, c[0][k], c[1][k], c[2][k], c[3][k]);
    s.output[k] =
        c[4][k] + electronics_at(gyro, s.temperature[kBoard][k]).offset;
    s.quadrature[k] = -c[5][k];
    s.drive_frequency[k] = drive.frequency / (2 * std::numbers::pi);
    s.drive_voltage[k] = drive.voltage;
    s.locked[k] = is_locked(drive);
  }
  return s;
}

NodeVector nodes_of(const VectorXd& y) {
  return y.segment<kThermalNodeCount>(kEnvelopeNodes);
}

// Whether the motion bends so often that an explicit method is the faster one.
bool needs_explicit_method(const ScenarioPlan& scenario, const Motion& motion) {
  constexpr double kBends = 50;  // [1/s]
  const std::size_t pieces =
      pieces_until(scenario.duration, motion.borders()).size();
  return static_cast<double>(pieces - 1) > kBends * scenario.duration;
}

// Where any input bends or jumps, or the start-up has ended.
std::vector<Border> borders_of(const ScenarioPlan& scenario,
                               const Motion& motion) {
  std::vector<Border> borders = motion.borders();
  for (const auto& more : {power_borders(scenario), scenario.ambient.borders()})
    borders.insert(borders.end(), more.begin(), more.end());
  return borders;
}

}  // namespace

EnvelopeTrajectory::EnvelopeTrajectory(const ScenarioPlan& scenario,
                                       const TrimmedGyro& gyro,
                                       const Motion& motion, bool at_rest,
                                       const ModalMemory* memory,
                                       double tolerance)
    : scenario_(scenario),
      gyro_(gyro),
      motion_(motion),
      at_rest_(at_rest),
      limits_(scenario, gyro.device.thermal),
      ode_(gyro, drive_heating(gyro), memory),
      stability_(rebalance_stability(gyro)),
      pieces_(pieces_until(scenario.duration, borders_of(scenario, motion))) {
  const auto rhs = [this](double t, const auto& y, auto dydt) {
    ode_.rate(inputs(t), y, dydt);
  };
  const VectorXd start = ode_.at_rest(scenario.ambient.value(0));
  const VectorXd absolute = tolerance * envelope_error_weights(gyro, ode_);
  if (needs_explicit_method(scenario, motion)) {
    ExplicitRkOptions options;
    options.table = RkTable::kDormandPrince;
    options.absolute_tolerance = absolute;
    explicit_ = std::make_unique<ExplicitRk>(rhs, 0.0, start, options);
    integrator_ = explicit_.get();
  } else {
    CvodeOptions options;
    options.relative_tolerance = 0;
    options.absolute_tolerance = absolute;
    options.stability_limit_detection = true;
    options.max_steps_per_advance = 100'000'000;
    options.jacobian = [this](double t, const auto& y, auto slope) {
      ode_.jacobian(inputs(t), y, slope);
    };
    multistep_ = std::make_unique<Cvode>(rhs, 0.0, start, options);
    integrator_ = multistep_.get();
  }
  begin(0);
}

EnvelopeInputs EnvelopeTrajectory::inputs(double t) const {
  return {.motion = at_rest_ ? segment_->at_rest(t) : segment_->at(t),
          .surroundings = {ambient_.at(t), scenario_.stirred},
          .powered = powered_,
          .time = t};
}

void EnvelopeTrajectory::begin(std::size_t piece) {
  const bool was_powered = powered_;
  const Piece& p = pieces_[piece];
  piece_ = piece;
  powered_ = powered_at(scenario_.powered, p.start);
  ambient_ = scenario_.ambient.stretch(p.start, p.end);
  segment_ = motion_.segment(p.start, p.end);
  if (!p.jump && piece > 0) return;
  VectorXd y = integrator_->state();
  if (powered_ != was_powered) {
    // Vibration, that of spurious modes too, decays within a second after
    // power-off, and the loops and an oven start from zero.
    y.head<kEnvelopeNodes>().setZero();
    y.tail(y.size() - kEnvelopeNodes - kThermalNodeCount).setZero();
  }
  integrator_->restart(p.start, y);
}

void EnvelopeTrajectory::check(double t, const VectorXd& y) {
  const NodeVector nodes = nodes_of(y);
  limits_.check(t, nodes);
  if (stability_ &&
      is_locked(drive_signals(ode_.loops(), y(kFeedback2), y(kFeedback2 + 1),
                              y(kPllIntegral), y(kAgcIntegral))))
    stability_->check(t, nodes(kBeam), nodes(kBoard));
}

void EnvelopeTrajectory::advance_to(double t_end, StateSamples& sampler) {
  if (multistep_) {
    multistep_->advance_to(t_end, [&](const OdeStep& step) {
      check(step.end, step.at(step.end));
      sampler.take(step);
    });
    return;
  }
  while (!sampler.complete() && sampler.next_time() < t_end) {
    const double t = sampler.next_time();
    const VectorXd& y = explicit_->advance_to(t);
    check(t, y);
    sampler.take_until(t, y);
  }
  explicit_->advance_to(t_end);
}

RunSamples EnvelopeTrajectory::advance(std::span<const double> times) {
  StateSamples sampler(times, kStoredStates);
  while (!sampler.complete()) {
    const Piece& piece = pieces_[piece_];
    const double end = std::min(piece.end, times.back());
    advance_to(end, sampler);
    if (end == piece.end && piece_ + 1 < pieces_.size()) begin(piece_ + 1);
    sampler.take_until(integrator_->time(), integrator_->state());
  }
  RunSamples samples =
      samples_of_states(sampler.columns(), ode_.loops(), gyro_);
  samples.time.assign(times.begin(), times.end());
  return samples;
}

void simulate_envelope(const ScenarioPlan& given, const TrimmedGyro& gyro,
                       const RunKey& key, const BlockSink& on_block) {
  const ScenarioPlan scenario = with_aligned_borders(given);
  LoopRun run(scenario, gyro, key);
  const Motion& motion = run.motion();
  EnvelopeTrajectory trajectory(scenario, gyro, motion, false, run.memory());
  std::optional<EnvelopeTrajectory> twin;
  if (!motion.rate_is_zero())
    twin.emplace(scenario, gyro, motion, true, run.memory());
  const SampleGrid grid = sample_grid(scenario);
  for (std::size_t k = 0; k < grid.count; k += kBlockSamples) {
    const std::vector<double> block =
        grid.times(k, std::min(kBlockSamples, grid.count - k));
    RunSamples samples = trajectory.advance(block);
    samples.bias = twin ? twin->advance(block).output : samples.output;
    on_block(run.block(std::move(samples)));
  }
}

}  // namespace beamgyro::internal
