// SPDX-License-Identifier: MIT
#include "compensation/thermistor_network.h"

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kZeroCelsius = 273.15;            // [K]
constexpr double kNominal = 298.15;                // [K]
constexpr double kLargestLog = 6.907755278982137;  // ln 1000

ArrayXd thermistor(const Eigen::Ref<const ArrayXd>& x, double b_K) {
  return x.unaryExpr([b_K](double T) {
    return std::exp(b_K * (1.0 / (T + kZeroCelsius) - 1.0 / kNominal));
  });
}

template <class Real>
Real divided(const Real& series, const Real& parallel, const Real& divider,
             double n) {
  return divider / (divider + series + n * parallel / (n + parallel));
}

// Residuals over (ln r_s, ln r_p, ln r_d, offset, gain). The logarithms bend
// into (-kLargestLog, kLargestLog).
struct Residuals {
  const ArrayXd& n;
  const ArrayXd& y;

  int NumResiduals() const { return static_cast<int>(n.size()); }

  template <class Real>
  bool operator()(const Real* w, Real* residuals) const {
    using std::exp;
    using std::tanh;
    const auto resistance = [](const Real& bent) {
      return exp(kLargestLog * tanh(bent / kLargestLog));
    };
    const Real s = resistance(w[0]), p = resistance(w[1]), d = resistance(w[2]);
    for (Index k = 0; k < n.size(); ++k)
      residuals[k] = w[3] + w[4] * divided(s, p, d, n(k)) - y(k);
    return true;
  }
};

using Problem = ceres::TinySolverAutoDiffFunction<Residuals, Eigen::Dynamic, 5>;
using Weights = Eigen::Matrix<double, 5, 1>;

// Sum of squares with the best offset and gain, which go into `w`.
double solve_for_offset_and_gain(const ArrayXd& n, const ArrayXd& y,
                                 Weights& w) {
  const double s = std::exp(w(0)), p = std::exp(w(1)), d = std::exp(w(2));
  const ArrayXd share =
      n.unaryExpr([&](double each) { return divided(s, p, d, each); });
  const ArrayXd from_mean = share - share.mean();
  const double spread = from_mean.square().sum();
  if (!(spread > 1e-18 * static_cast<double>(n.size())))
    return std::numeric_limits<double>::infinity();
  w(4) = (from_mean * y).sum() / spread;
  w(3) = y.mean() - w(4) * share.mean();
  return (w(3) + w(4) * share - y).square().sum();
}

}  // namespace

ArrayXd ThermistorNetwork::predict(const Eigen::Ref<const ArrayXd>& x) const {
  return thermistor(x, b_K).unaryExpr([this](double n) {
    return offset + gain * divided(series, parallel, divider, n);
  });
}

ThermistorNetwork fit_thermistor_network(const Eigen::Ref<const ArrayXd>& x,
                                         const Eigen::Ref<const ArrayXd>& y,
                                         double b_K) {
  if (x.size() < 5 || !(x.maxCoeff() > x.minCoeff()))
    throw std::invalid_argument(
        fmt::format("thermistor: {} rows over {:.3g} K, must be at least 5 of "
                    "several temperatures",
                    x.size(), x.size() ? x.maxCoeff() - x.minCoeff() : 0.0));
  const ArrayXd n = thermistor(x, b_K), target = y;
  Weights best;
  double least = std::numeric_limits<double>::infinity();
  constexpr double kStarts[] = {-4.0, -2.0, -0.7, 0.7, 2.0, 4.0};
  for (const double s : kStarts)
    for (const double p : kStarts)
      for (const double d : kStarts) {
        Weights w{s, p, d, 0.0, 0.0};
        const double sum = solve_for_offset_and_gain(n, target, w);
        if (sum < least) {
          least = sum;
          best = w;
        }
      }
  // The grid's logarithms, bent the other way.
  for (int i = 0; i < 3; ++i)
    best(i) = kLargestLog * std::atanh(best(i) / kLargestLog);
  const Residuals residuals{n, target};
  Problem problem(residuals);
  ceres::TinySolver<Problem> solver;
  solver.options.max_num_iterations = 200;
  solver.options.gradient_tolerance = 1e-14;
  solver.Solve(problem, &best);
  const auto resistance = [&](int i) {
    return std::exp(kLargestLog * std::tanh(best(i) / kLargestLog));
  };
  return {b_K, resistance(0), resistance(1), resistance(2), best(3), best(4)};
}

}  // namespace beamgyro
