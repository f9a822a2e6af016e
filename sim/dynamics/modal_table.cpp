// SPDX-License-Identifier: MIT
#include "sim/dynamics/modal_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {

Eigen::Matrix2d stiffness_of(const ModalChannels& channels) {
  Eigen::Matrix2d K;
  K << channels(kStiffnessXx), channels(kStiffnessXy), channels(kStiffnessXy),
      channels(kStiffnessYy);
  return K;
}

Eigen::Matrix2d damping_of(const ModalChannels& channels) {
  Eigen::Matrix2d C;
  C << channels(kDampingXx), channels(kDampingXy), channels(kDampingXy),
      channels(kDampingYy);
  return C;
}

Complex coupling_of(const ModalChannels& channels, Patch patch) {
  const Eigen::Index i = kCouplings + 2 * Eigen::Index{patch};
  return {channels(i), channels(i + 1)};
}

ModalTable::ModalTable(const TrimmedGyro& gyro) : gyro_(gyro) {
  for (std::size_t p = 0; p < direction_.size(); ++p) {
    direction_[p] =
        patch_position(gyro.device, static_cast<Patch>(p)).normalized();
  }
  const auto cells =
      static_cast<std::size_t>((kHottestBeam - kColdestBeam) / kModalGrid);
  cells_.resize(cells);
}

ModalChannels modal_channels(const TrimmedGyro& gyro, double T,
                             const MemoryState& memory) {
  const ModalParameters modal = modal_at(gyro, T, memory);
  ModalChannels c;
  c.head<kCouplings>() << modal.stiffness(0, 0), modal.stiffness(0, 1),
      modal.stiffness(1, 1), modal.damping(0, 0), modal.damping(0, 1),
      modal.damping(1, 1);
  for (std::size_t p = 0; p < modal.coupling.size(); ++p) {
    const Eigen::Vector2d direction =
        patch_position(gyro.device, static_cast<Patch>(p)).normalized();
    const Complex along =
        direction.cast<Complex>().transpose() * modal.coupling[p];
    const auto i = kCouplings + 2 * static_cast<Eigen::Index>(p);
    c(i) = along.real();
    c(i + 1) = along.imag();
  }
  return c / gyro.beam.mass;
}

// Through both ends and the inner Chebyshev-Lobatto points at 1/4 and 3/4.
ModalTable::Cubic ModalTable::cubic(double left, double right) const {
  const auto at = [&](double s) {
    return modal_channels(gyro_, std::lerp(left, right, s));
  };
  const ModalChannels a = at(0), b = at(0.25), c = at(0.75), d = at(1);
  return {a, (-19 * a + 24 * b - 8 * c + 3 * d) / 3,
          (32 * a - 56 * b + 40 * c - 16 * d) / 3,
          (-16 * a + 32 * b - 32 * c + 16 * d) / 3};
}

bool are_equal(const ModalChannels& have, const ModalChannels& want) {
  constexpr double kForce = 1e-13, kCoupling = 1e-9;  // relative
  const ModalChannels error = (have - want).abs();
  const double stiffness = kForce * want(kStiffnessXx);
  const double damping = stiffness / std::sqrt(want(kStiffnessXx));
  return error.segment<3>(kStiffnessXx).maxCoeff() <= stiffness &&
         error.segment<3>(kDampingXx).maxCoeff() <= damping &&
         (error.tail(2 * kPatchCount) <=
          kCoupling * want.tail(2 * kPatchCount).abs().maxCoeff())
             .all();
}

// Against the exact parameters where a cubic through those points is worst.
bool ModalTable::accurate(const Cubic& cubic, double left, double right) const {
  for (const double s : {0.1, 0.5, 0.9}) {
    if (!are_equal(cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3])),
                   modal_channels(gyro_, std::lerp(left, right, s))))
      return false;
  }
  return true;
}

const std::vector<ModalTable::Cubic>& ModalTable::cell(std::size_t i) {
  constexpr std::size_t kMostParts = 256;  // 1 mK: what a kink is resolved to
  std::vector<Cubic>& parts = cells_[i];
  bool good = !parts.empty();
  for (std::size_t count = 1; !good; count *= 2) {
    const double left = kColdestBeam + kModalGrid * static_cast<double>(i);
    const double width = kModalGrid / static_cast<double>(count);
    parts.clear();
    good = true;
    for (std::size_t k = 0; k < count; ++k) {
      const double a = left + width * static_cast<double>(k), b = a + width;
      parts.push_back(cubic(a, b));
      good = good && (count == kMostParts || accurate(parts.back(), a, b));
      if (!good) break;
    }
  }
  return parts;
}

ModalTable::Point ModalTable::at(double T) {
  constexpr double kRoundoff = 1e-6;  // of an integration at the end [K]
  double place = (T - kColdestBeam) / kModalGrid;
  if (place < 0 && T > kColdestBeam - kRoundoff) place = 0;
  if (!(place >= 0) || !(place < static_cast<double>(cells_.size()))) {
    throw SimulationFailure(
        fmt::format("beam temperature {:.2f} degC is outside the model's "
                    "{:.0f} to {:.0f} degC",
                    T - kZeroCelsius, kColdestBeam - kZeroCelsius,
                    kHottestBeam - kZeroCelsius));
  }
  const auto i = static_cast<std::size_t>(place);
  const std::vector<Cubic>& parts = cell(i);
  const auto count = static_cast<double>(parts.size());
  const double along = (place - static_cast<double>(i)) * count;
  const std::size_t part =
      std::min(static_cast<std::size_t>(along), parts.size() - 1);
  const double s = along - static_cast<double>(part);
  const Cubic& c = parts[part];
  return {c[0] + s * (c[1] + s * (c[2] + s * c[3])),
          (c[1] + s * (2 * c[2] + 3 * s * c[3])) * (count / kModalGrid)};
}

ModalMemory::ModalMemory(const TrimmedGyro& gyro,
                         const MemoryTrajectory& memory)
    : memory_(memory) {
  const bool turns = gyro.device.memory.hysteresis.has_value();
  for (std::size_t k = 0; k < memory.times().size(); ++k) {
    const double T = memory.beam()[k];
    MemoryState state = memory.knot(k);
    const double hysteresis = state.hysteresis;
    state.hysteresis = 0;
    const ModalChannels without = modal_channels(gyro, T, state);
    without_hysteresis_.add(without - modal_channels(gyro, T));
    if (!turns) continue;
    state.hysteresis = hysteresis < 0 ? -1 : 1;
    per_hysteresis_.add((modal_channels(gyro, T, state) - without) *
                        state.hysteresis);
  }
  without_hysteresis_.finish(memory.times(), memory.breaks());
  if (turns) per_hysteresis_.finish(memory.times(), memory.breaks());
}

ModalChannels ModalMemory::at(double t, double beam,
                              std::size_t& interval) const {
  const std::vector<double>& times = memory_.times();
  interval = interval_of(times, t, interval);
  ModalChannels sum = without_hysteresis_.at(times, interval, t);
  if (!per_hysteresis_.values().empty()) {
    sum += memory_.hysteresis(interval, beam) *
           per_hysteresis_.at(times, interval, t);
  }
  return sum;
}

}  // namespace beamgyro::internal
