// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/numerics/timeline.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal {

/// The lowest and the highest temperature of a node.
struct TemperatureSpan {
  double low, high;  // [K]
};

/// The temperatures of a run at its samples, kept as the polynomials of the
/// integration's steps: some 300 bytes a step, however many samples it spans.
/// Where a step spans few samples their values are kept instead, 48 bytes each.
class ThermalTrajectory {
 public:
  /// Integrates; throws as integrate_temperatures(). `also` receives what the
  /// integration hands over, too.
  ThermalTrajectory(const ThermalNetwork& network, const ThermalLoad& load,
                    const SampleGrid& grid, const ThermalSink& also = {});

  /// Of the temperatures of a node at the samples.
  TemperatureSpan range(ThermalNode node) const;

  /// The temperature of a node [K] at the samples from `first` on, whose times
  /// are `times` [s], bit for bit that of simulate_temperatures().
  void sample(ThermalNode node, std::size_t first,
              std::span<const double> times,
              std::span<double> temperature) const;

 private:
  // Samples from `first` to that of the next stretch.
  struct Stretch {
    std::size_t first;
    std::size_t data;     // where its numbers begin in data_
    double centre, size;  // [s], of OdeStep
    int order;            // of the polynomial, or kValues
  };
  static constexpr int kValues = -1;

  void store(std::size_t last, const OdeStep& step);
  void store(std::size_t last, const Eigen::VectorXd& y);
  void begin_values();

  SampleGrid grid_;
  std::size_t kept_ = 0;  // samples
  std::vector<Stretch> stretches_;
  // Of each polynomial a row of coefficients for each node; of values one for
  // each node, sample after sample.
  std::vector<double> data_;
};

}  // namespace beamgyro::internal
