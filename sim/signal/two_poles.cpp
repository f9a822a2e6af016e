// SPDX-License-Identifier: MIT
#include "sim/signal/two_poles.h"

#include <cmath>

namespace beamgyro::internal {
namespace {

// A transient that has died out is 0: halved for ever it would stay a
// subnormal number, and those are a hundred times slower.
double alive(double transient) {
  return std::abs(transient) < 1e-290 ? 0.0 : transient;
}

}  // namespace

FilterStretch filter_stretch(double corner, double duration) {
  const double x = corner * duration;
  const double lost = -std::expm1(-x);
  return {x, 1.0 - lost, x > 0.0 ? lost / x : 1.0};
}

// Written in the differences to the input, with nothing large that cancels
// however steep the rise.
void TwoPoles::advance(const FilterStretch& stretch, double input,
                       double rise) {
  const double behind1 = alive(first - input);
  const double behind2 = alive(second - input);
  const double end = input + rise;
  first = end + stretch.decay * behind1 - rise * stretch.mean_decay;
  second = end + stretch.decay * (behind2 + stretch.x * behind1) +
           rise * (stretch.decay - 2.0 * stretch.mean_decay);
}

// p_n and q_n are what the first and the second pole make of x^(n-1)/(n-1)!,
// x = w t: p_n+1 = x^n/n! - p_n, q_n+1 = p_n+1 - q_n.
void TwoPoles::advance_square(double corner, double a, double b,
                              double duration) {
  const double x = corner * duration, decay = std::exp(-x);
  const double p1 = -std::expm1(-x), p2 = x - p1, p3 = x * x / 2 - p2;
  const double q1 = p1 - x * decay, q2 = p2 - q1, q3 = p3 - q2;
  const double c1 = a * a, c2 = 2 * a * b / corner;
  const double c3 = 2 * b * b / (corner * corner);
  second = decay * (second + x * first) + c1 * q1 + c2 * q2 + c3 * q3;
  first = decay * first + c1 * p1 + c2 * p2 + c3 * p3;
}

}  // namespace beamgyro::internal
