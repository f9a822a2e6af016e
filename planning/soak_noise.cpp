// SPDX-License-Identifier: MIT
#include "planning/soak_noise.h"

#include <cmath>
#include <cstddef>

namespace beamgyro::internal {

Eigen::MatrixXd slow_noise_root(const SlowNoise& noise,
                                const std::vector<double>& soaks,
                                const ChamberTime& time, bool start_row) {
  const auto count = static_cast<Eigen::Index>(soaks.size());
  const std::vector<Visit> stops = visits(soaks, time);
  const Eigen::Index rows = count + (start_row ? 1 : 0);
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(rows, 1 + count + rows);
  root.col(0).setConstant(noise.turn_on);
  root.rightCols(rows).diagonal().setConstant(noise.own);
  for (Eigen::Index k = 0; k < count; ++k) {
    double before = 0.0;
    for (Eigen::Index step = 0; step < count; ++step) {
      const Visit& stop = stops[static_cast<std::size_t>(step)];
      root(k, 1 + step) = noise.walk * std::sqrt(stop.end - before);
      before = stop.end;
      if (stop.temperature == soaks[static_cast<std::size_t>(k)]) break;
    }
  }
  return root;
}

}  // namespace beamgyro::internal
