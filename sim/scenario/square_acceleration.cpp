// SPDX-License-Identifier: MIT
#include "sim/scenario/square_acceleration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace beamgyro {
namespace {

using Samples = std::vector<double>;

// y_1' = w (u - y_1), y_2' = w (y_1 - y_2)
class TwoPoles {
 public:
  TwoPoles(double corner, double settled)
      : w_(corner), y1_(settled), y2_(settled) {}

  double output() const { return y2_; }

  // Over `time` [s] of u = (a + b t)^2, exactly. p_n and q_n are what the first
  // and the second pole make of x^(n-1)/(n-1)!, x = w t: p_n+1 = x^n/n! - p_n,
  // q_n+1 = p_n+1 - q_n.
  void advance(double a, double b, double time) {
    const double x = w_ * time, decay = std::exp(-x);
    const double p1 = -std::expm1(-x), p2 = x - p1, p3 = x * x / 2 - p2;
    const double q1 = p1 - x * decay, q2 = p2 - q1, q3 = p3 - q2;
    const double c1 = a * a, c2 = 2 * a * b / w_, c3 = 2 * b * b / (w_ * w_);
    y2_ = decay * (y2_ + x * y1_) + c1 * q1 + c2 * q2 + c3 * q3;
    y1_ = decay * y1_ + c1 * p1 + c2 * p2 + c3 * p3;
  }

 private:
  double w_;  // [rad/s]
  double y1_, y2_;
};

void add_square(const PiecewiseLinear& points, double corner,
                double output_rate, Samples& sum) {
  const std::vector<double> knots = points.breakpoints();
  auto next = std::upper_bound(knots.begin(), knots.end(), 0.0);
  // The piece that starts at t0: a + b (t - t0), until `next`.
  double t0 = 0, a = points.value(0), b = 0, t = 0;
  const auto find_slope = [&] {
    b = next == knots.end() ? 0
                            : (points.value_before(*next) - a) / (*next - t0);
  };
  find_slope();
  TwoPoles filter(corner, a * a);
  const auto advance_to = [&](double end) {
    filter.advance(a + b * (t - t0), b, end - t);
    t = end;
  };
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const double sample = static_cast<double>(k) / output_rate;
    for (; next != knots.end() && *next <= sample; find_slope()) {
      advance_to(*next);
      t0 = *next++;
      a = points.value(t0);
    }
    advance_to(sample);
    sum[k] += filter.output();
  }
}

// (o + A sin p)^2 = o^2 + A^2/2 + 2 o A sin p + A^2/2 sin(2 p - 90 deg)
void add_square(const SineSignal& sine, double corner, double output_rate,
                Samples& sum) {
  const double o = sine.offset, A = sine.amplitude;
  const SineSignal once{.offset = o * o + A * A / 2,
                        .amplitude = 2 * o * A,
                        .frequency = sine.frequency,
                        .phase = sine.phase};
  const SineSignal twice{.amplitude = A * A / 2,
                         .frequency = 2 * sine.frequency,
                         .phase = 2 * sine.phase - std::numbers::pi / 2};
  const OutputFilter filter(corner);
  for (const SineSignal& part : {once, twice}) {
    const Samples shown = filter.response(part, output_rate, sum.size());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += shown[k];
  }
}

}  // namespace

std::vector<double> filtered_square_acceleration(const Scenario& scenario,
                                                 double corner,
                                                 const RunKey& key) {
  Samples sum(sample_count(scenario), 0.0);
  for (std::size_t i = 0; i < scenario.acceleration.size(); ++i) {
    const RateProfile& profile = scenario.acceleration[i];
    if (!moves(profile)) continue;
    if (const auto* sine = std::get_if<SineSignal>(&profile)) {
      add_square(*sine, corner, scenario.output_rate, sum);
      continue;
    }
    const auto* random = std::get_if<RandomRate>(&profile);
    add_square(random ? realised(*random, scenario.duration, scenario.seed,
                                 key.device, key.run, kAccelerationPurposes[i])
                      : std::get<PiecewiseLinear>(profile),
               corner, scenario.output_rate, sum);
  }
  return sum;
}

}  // namespace beamgyro
