// SPDX-License-Identifier: MIT
#include "tests/compensation/rows_of.h"

#include "random/random_stream.h"

namespace beamgyro::internal {

TrainingRows rows_of(const std::vector<Leg>& legs,
                     const std::function<double(double, int)>& bias) {
  Eigen::Index count = 0;
  for (const Leg& leg : legs) count += leg.rows;
  TrainingRows rows;
  rows.inputs.resize(count, 1);
  rows.temperature = rows.bias = rows.time = Eigen::ArrayXd(count);
  rows.run = rows.cycle = rows.leg = Eigen::ArrayXi(count);
  Eigen::Index k = 0;
  for (std::size_t n = 0; n < legs.size(); ++n) {
    const Leg& leg = legs[n];
    for (int i = 0; i < leg.rows; ++i, ++k) {
      const double share = leg.rows > 1 ? i / (leg.rows - 1.0) : 0.0;
      rows.temperature(k) = leg.from + share * (leg.to - leg.from);
      rows.bias(k) = bias(rows.temperature(k), static_cast<int>(k));
      rows.time(k) = 60.0 * static_cast<double>(k);
      rows.run(k) = leg.run;
      rows.cycle(k) = leg.cycle;
      rows.leg(k) = static_cast<int>(n);
    }
  }
  rows.device = rows.run;
  rows.beyond_range.setZero(count);
  rows.inputs.col(0) = rows.temperature;
  rows.range = {rows.temperature.minCoeff(), rows.temperature.maxCoeff()};
  return rows;
}

std::vector<double> every_five_kelvins() {
  std::vector<double> temperatures;
  for (int T = -40; T <= 50; T += 5) temperatures.push_back(T);
  return temperatures;
}

std::vector<double> white(int count, std::uint32_t run) {
  RandomStream random(17, 0, run, RandomPurpose{0});
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = random.normal();
  return values;
}

}  // namespace beamgyro::internal
