// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sim/dynamics/carrier.h"
#include "sim/numerics/ode.h"
#include "sim/scenario/drive_lock.h"
#include "sim/scenario/loop_run.h"
#include "sim/scenario/run_stability.h"
#include "sim/scenario/run_temperatures.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {
namespace {

using Eigen::VectorXd;

constexpr double kWindow = 1.0;         // [s], phases are exact over one
constexpr double kTolerance = 1e-7;     // local, in the output [rad/s]
constexpr double kThermalStep = 0.1;    // [s], temperatures linear between
constexpr double kBlockTime = 5.0;      // [s]
constexpr double kUsualCost = 0.45;     // of a second, on no old machine [s]
constexpr double kTimedPart = 1.0;      // [s], of the run that is timed
constexpr double kWorthMeasuring = 60;  // [s]

// Local error of each state that matters as much as one of 1 rad/s in the
// output.
VectorXd carrier_error_weights(const TrimmedGyro& gyro, const CarrierOde& ode) {
  VectorXd weights = VectorXd::Ones(ode.size());
  for (const Eigen::Index i : {kPosition, kVelocity}) {
    weights(i) = 0.3;
    weights(i + 1) = 2e-3;
  }
  weights.segment<4>(kFeedback1).setConstant(0.3);
  weights(kPllIntegral) = 100;
  weights(kAgcIntegral) = 0.3;
  weights(kCarrierPhase) = 0.3;
  const VectorXd spurious = spurious_error_weights(gyro);
  weights.tail(spurious.size()) = spurious;
  return weights;
}

// One trajectory in order of time, from tick to tick.
class CarrierTrajectory {
 public:
  CarrierTrajectory(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                    const Motion& motion, const RunTemperatures& temperatures,
                    const ModalMemory* memory, bool at_rest)
      : scenario_(scenario),
        motion_(motion),
        temperatures_(temperatures),
        memory_(memory),
        at_rest_(at_rest),
        angular_gain_(gyro.beam.angular_gain),
        ode_(gyro) {
    ExplicitRkOptions options;
    options.absolute_tolerance = kTolerance * carrier_error_weights(gyro, ode_);
    rk_ = std::make_unique<ExplicitRk>(
        [this](double t, const auto& y, auto dydt) {
          ode_.rate(t, moving(t), y, dydt);
        },
        0.0, ode_.at_rest(), options);
    std::vector<Border> borders = motion.borders();
    const std::vector<Border> power = power_borders(scenario);
    borders.insert(borders.end(), power.begin(), power.end());
    pieces_ = pieces_until(scenario.duration, std::move(borders));
    begin(0);
  }

  const LoopElectronics& loops() const { return ode_.loops(); }

  // The state at `t` [s], later than all before.
  const VectorXd& at(double t) {
    while (time_ < t) step(t);
    return rk_->state();
  }

 private:
  CaseMotion moving(double t) const {
    const double now = window_ + t;
    return at_rest_ ? segment_->at_rest(now) : segment_->at(now);
  }

  // Ends the present piece and begins another one now.
  void begin(std::size_t piece) {
    const double before = segment_ ? segment_->at(pieces_[piece_].end).z : 0;
    piece_ = piece;
    const Piece& p = pieces_[piece];
    segment_ = motion_.segment(p.start, p.end);
    if (powered_ && !at_rest_) turn_by(segment_->at(p.start).z - before);
    const bool powered = powered_at(scenario_.powered, p.start);
    if (powered != powered_) {
      powered_ = powered;
      start_window(ode_.at_rest());
    }
  }

  // A jump of the rate is an impulse of the Euler force (2.1):
  // q' changes by -gamma J2 q times the jump.
  void turn_by(double jump) {
    if (jump == 0) return;
    VectorXd y = rk_->state();
    const double turn = angular_gain_ * jump / ode_.loops().nominal_frequency;
    y(kVelocity) += turn * y(kPosition + 1);
    y(kVelocity + 1) -= turn * y(kPosition);
    rk_->restart(time_ - window_, y);
  }

  void start_window(const VectorXd& y) {
    ode_.begin_window(time_ - window_);
    window_ = time_;
    rk_->restart(0, y);
  }

  void step(double t) {
    const double border = pieces_[piece_].end;
    const double end = std::min({t, border, time_ + kCarrierTick});
    if (powered_) {
      if (time_ - window_ >= kWindow) start_window(rk_->state());
      const double middle = 0.5 * (time_ + end);
      set_temperatures(middle);
      rk_->advance_to(end - window_);
    }
    time_ = end;
    if (end == border && piece_ + 1 < pieces_.size()) begin(piece_ + 1);
  }

  void set_temperatures(double t) {
    const double beam = temperatures_.at(kBeam, t);
    const double board = temperatures_.at(kBoard, t);
    if (memory_ == nullptr) {
      ode_.set_temperatures(beam, board);
    } else {
      ode_.set_temperatures(beam, board,
                            memory_->at(t, beam, memory_interval_));
    }
    if (ode_.has_spurious_modes()) {
      ode_.set_spurious({beam, temperatures_.at(kHousing, t)},
                        memory_ ? memory_->state(t, beam) : MemoryState{});
    }
  }

  const ScenarioPlan& scenario_;
  const Motion& motion_;
  const RunTemperatures& temperatures_;
  const ModalMemory* memory_;
  std::size_t memory_interval_ = 0;
  bool at_rest_;
  double angular_gain_;
  CarrierOde ode_;
  std::unique_ptr<ExplicitRk> rk_;
  std::vector<Piece> pieces_;
  std::size_t piece_ = 0;
  std::optional<MotionSegment> segment_;
  bool powered_ = false;
  double time_ = 0;    // [s]
  double window_ = 0;  // start of the window [s]
};

double shown_rate(const TrimmedGyro& gyro, const VectorXd& y, double board) {
  return y(kOutput2) + electronics_at(gyro, board).offset;
}

RunSamples samples_at(std::span<const double> times, const TrimmedGyro& gyro,
                      const RunTemperatures& temperatures,
                      CarrierTrajectory& trajectory, CarrierTrajectory* twin) {
  RunSamples s;
  s.time.assign(times.begin(), times.end());
  for (std::size_t node = 0; node < kThermalNodeCount; ++node) {
    for (const double t : times)
      s.temperature[node].push_back(
          temperatures.at(static_cast<ThermalNode>(node), t));
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double board = s.temperature[kBoard][k];
    const VectorXd& y = trajectory.at(times[k]);
    const DriveSignals drive =
        drive_signals(trajectory.loops(), y(kFeedback2), y(kFeedback2 + 1),
                      y(kPllIntegral), y(kAgcIntegral));
    s.output.push_back(shown_rate(gyro, y, board));
    s.quadrature.push_back(-y(kOutput2 + 1));
    s.drive_frequency.push_back(drive.frequency / (2 * std::numbers::pi));
    s.drive_voltage.push_back(drive.voltage);
    s.locked.push_back(is_locked(drive));
    s.bias.push_back(twin ? shown_rate(gyro, twin->at(times[k]), board)
                          : s.output.back());
  }
  return s;
}

void require_rate(const ScenarioPlan& scenario, const TrimmedGyro& gyro) {
  const double drive =
      loop_electronics(gyro).nominal_frequency / (2 * std::numbers::pi);
  if (scenario.output_rate <= drive / 4) return;
  throw std::invalid_argument(
      fmt::format("output_rate_Hz: {:g} is above what the carrier fidelity "
                  "allows; expected at most {:.1f}, a quarter of the drive "
                  "frequency",
                  scenario.output_rate, drive / 4));
}

// Wall time [s] here and now of a second of the run with power.
double measured_cost(const ScenarioPlan& scenario, const TrimmedGyro& gyro) {
  ScenarioPlan first = scenario;
  first.duration = std::min(kTimedPart, scenario.duration);
  first.output_rate = std::max(scenario.output_rate, 2 / first.duration);
  first.powered = {{0, first.duration}};
  const auto start = std::chrono::steady_clock::now();
  simulate_carrier(first, gyro, {}, [](const auto&) {});
  const std::chrono::duration<double> taken =
      std::chrono::steady_clock::now() - start;
  return taken.count() / first.duration;
}

}  // namespace

double carrier_cost(const ScenarioPlan& scenario, const TrimmedGyro& gyro) {
  double powered = 0;
  for (const PowerInterval& interval : scenario.powered) {
    powered +=
        std::max(0.0, std::min(interval.off, scenario.duration) - interval.on);
  }
  const double usual =
      powered * kUsualCost * (moves(scenario.motion[kRateZ]) ? 2 : 1);
  return usual < kWorthMeasuring ? usual
                                 : powered * measured_cost(scenario, gyro);
}

void simulate_carrier(const ScenarioPlan& given, const TrimmedGyro& gyro,
                      const RunKey& key, const BlockSink& on_block) {
  const ScenarioPlan scenario = with_aligned_borders(given);
  require_rate(scenario, gyro);
  const RunTemperatures temperatures(scenario, gyro, kThermalStep);
  LoopRun run(scenario, gyro, key);
  const Motion& motion = run.motion();
  CarrierTrajectory trajectory(scenario, gyro, motion, temperatures,
                               run.memory(), false);
  std::optional<CarrierTrajectory> twin;
  if (!motion.rate_is_zero())
    twin.emplace(scenario, gyro, motion, temperatures, run.memory(), true);
  std::optional<RebalanceStability> stability = rebalance_stability(gyro);
  const SampleGrid grid = sample_grid(scenario);
  // Blocks are short, because progress is reported after each.
  const auto block_size =
      std::clamp(static_cast<std::size_t>(kBlockTime * scenario.output_rate),
                 std::size_t{1}, kBlockSamples);
  for (std::size_t k = 0; k < grid.count; k += block_size) {
    const std::vector<double> block =
        grid.times(k, std::min(block_size, grid.count - k));
    RunSamples samples = samples_at(block, gyro, temperatures, trajectory,
                                    twin ? &*twin : nullptr);
    if (stability) check_stability(scenario, samples, *stability);
    on_block(run.block(std::move(samples)));
  }
}

}  // namespace beamgyro::internal
