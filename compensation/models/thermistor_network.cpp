// SPDX-License-Identifier: MIT
#include "compensation/models/thermistor_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "compensation/firmware/runtime.h"
#include "compensation/models/parameter_json.h"
#include "config/units.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;

constexpr double kNominal = 298.15;  // [K]

ArrayXd thermistor(const Eigen::Ref<const ArrayXd>& x, double b_K) {
  return x.unaryExpr([b_K](double T) {
    return std::exp(b_K * (1.0 / (T + kZeroCelsius) - 1.0 / kNominal));
  });
}

// b_0 and b_1 of least squares at one bend.
struct CurveLine {
  double b0 = 0.0, b1 = 0.0;
  double squares = std::numeric_limits<double>::infinity();
};

CurveLine line_at(double log_bend, const ArrayXd& n, const ArrayXd& y) {
  const ArrayXd share = 1.0 / (1.0 + n / std::exp(log_bend));
  const ArrayXd from_mean = share - share.mean();
  const double spread = from_mean.square().sum();
  if (!(spread > 0.0)) return {};
  CurveLine line;
  line.b1 = (from_mean * (y - y.mean())).sum() / spread;
  line.b0 = y.mean() - line.b1 * share.mean();
  line.squares = (line.b0 + line.b1 * share - y).square().sum();
  return line;
}

// Golden section between the neighbours of the best of a grid of bends.
double best_log_bend(const ArrayXd& n, const ArrayXd& y) {
  const double low = std::log(kLeastBend), high = std::log(kLargestBend);
  constexpr int kGrid = 200;
  const double step = (high - low) / kGrid;
  const auto squares = [&](double log_bend) {
    return line_at(log_bend, n, y).squares;
  };
  double best = low, least = squares(low);
  for (int k = 1; k <= kGrid; ++k) {
    const double here = squares(low + step * k);
    if (here < least) {
      least = here;
      best = low + step * k;
    }
  }
  double from = std::max(best - step, low), to = std::min(best + step, high);
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = to - golden * (to - from), b = from + golden * (to - from);
  double at_a = squares(a), at_b = squares(b);
  while (to - from > 1e-12) {
    if (at_a <= at_b) {
      to = b;
      b = a;
      at_b = at_a;
      a = to - golden * (to - from);
      at_a = squares(a);
    } else {
      from = a;
      a = b;
      at_a = at_b;
      b = from + golden * (to - from);
      at_b = squares(b);
    }
  }
  return 0.5 * (from + to);
}

}  // namespace

ArrayXd ThermistorNetwork::predict(const Eigen::Ref<const ArrayXd>& x) const {
  return thermistor(x, b_K).unaryExpr([this](double n) {
    return offset +
           gain * divider / (divider + series + n * parallel / (n + parallel));
  });
}

ThermistorNetwork fit_thermistor_network(const Eigen::Ref<const ArrayXd>& x,
                                         const Eigen::Ref<const ArrayXd>& y,
                                         double b_K) {
  if (x.size() < 3 || !(x.maxCoeff() > x.minCoeff()))
    throw std::invalid_argument(
        fmt::format("thermistor: {} rows over {:.3g} K, must be at least 3 of "
                    "several temperatures",
                    x.size(), x.size() ? x.maxCoeff() - x.minCoeff() : 0.0));
  const ArrayXd n = thermistor(x, b_K), target = y;
  const double log_bend = best_log_bend(n, target);
  const CurveLine line = line_at(log_bend, n, target);
  // With r_s = r_d = n', r_p = 2 n' the divided share runs from 1 / 2 at n = 0
  // to 1 / 4: share = 1 / 4 + 1 / 4 / (1 + n / n').
  const double bend = std::exp(log_bend);
  return {b_K, bend, 2.0 * bend, bend, line.b0 - line.b1, 4.0 * line.b1};
}

nlohmann::ordered_json ThermistorNetwork::parameters() const {
  return {{"b_K", finite_json(b_K)},
          {"series", finite_json(series)},
          {"parallel", finite_json(parallel)},
          {"divider", finite_json(divider)},
          {"offset_deg_per_s", finite_json(offset)},
          {"gain_deg_per_s", finite_json(gain)}};
}

ThermistorNetwork ThermistorNetwork::read(const JsonNode& node, std::size_t) {
  return {
      read_positive(node.at("b_K")),        read_positive(node.at("series")),
      read_positive(node.at("parallel")),   read_positive(node.at("divider")),
      node.at("offset_deg_per_s").number(), node.at("gain_deg_per_s").number()};
}

void ThermistorNetwork::put_arrays(FirmwareArrays& arrays) const {
  arrays.add(
      {"network", "B [K], r_s, r_p, r_d, offset, gain [deg/s]",
       singles(std::vector{b_K, series, parallel, divider, offset, gain})});
}

float ThermistorNetwork::firmware_value(const FirmwareArrays& arrays,
                                        std::span<const float> x) const {
  return runtime::thermistor_at(arrays.data("network"), x[0]);
}

FirmwareCode ThermistorNetwork::firmware_code(std::size_t) const {
  return {{"exp", "thermistor"}, "  return thermistor_at(network, x[0]);\n"};
}

}  // namespace beamgyro::internal
