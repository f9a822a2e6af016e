// SPDX-License-Identifier: MIT
#include "bench/bias_rows.h"

#include <cmath>

#include "random/random_stream.h"

namespace beamgyro::internal {

ScaledRows bias_rows(Eigen::Index count, Eigen::Index inputs, double noise,
                     std::uint32_t run) {
  RandomStream random(5, 0, run, kWhiteNoiseStream);
  ScaledRows set;
  set.inputs.resize(count, inputs);
  set.target.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    set.inputs(i, 0) =
        2 * static_cast<double>(i) / static_cast<double>(count - 1) - 1;
    double x = set.inputs(i, 0);
    for (Eigen::Index j = 1; j < inputs; ++j) {
      set.inputs(i, j) = 2 * random.uniform() - 1;
      x += 0.05 * set.inputs(i, j);
    }
    set.target(i) = 0.4 * std::sin(4 * x) + 0.5 * std::tanh(-6 * (x + 0.35)) +
                    noise * random.normal();
  }
  return set;
}

}  // namespace beamgyro::internal
