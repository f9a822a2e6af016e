// SPDX-License-Identifier: MIT
#include "compensation/models/cubic_spline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "compensation/firmware/runtime.h"
#include "compensation/models/array_view.h"
#include "compensation/models/bias_function.h"
#include "compensation/models/parameter_json.h"
#include "linear_algebra/least_squares.h"
#include "linear_algebra/linear_systems.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

// Interval [x_k, x_{k+1}] used at x, and the four factors of its end values
// and end second derivatives.
struct Piece {
  Index k;
  double a, b, c, d;
};

Piece piece_at(const ArrayXd& knots, double x) {
  const double* first = knots.data() + 1;
  const double* last = knots.data() + knots.size() - 1;
  const Index k = std::upper_bound(first, last, x) - first;
  const double h = knots(k + 1) - knots(k);
  const double a = (knots(k + 1) - x) / h, b = (x - knots(k)) / h;
  const double sixth = h * h / 6.0;
  return {k, a, b, (a * a * a - a) * sixth, (b * b * b - b) * sixth};
}

// M = S y: continuity of s' at the inner knots and the two end conditions.
MatrixXd second_derivative_operator(const ArrayXd& knots, SplineEnd end) {
  const Index n = knots.size();
  const ArrayXd h = knots.tail(n - 1) - knots.head(n - 1);
  MatrixXd left = MatrixXd::Zero(n, n), right = MatrixXd::Zero(n, n);
  for (Index k = 1; k + 1 < n; ++k) {
    left(k, k - 1) = h(k - 1) / 6.0;
    left(k, k) = (h(k - 1) + h(k)) / 3.0;
    left(k, k + 1) = h(k) / 6.0;
    right(k, k - 1) = 1.0 / h(k - 1);
    right(k, k) = -1.0 / h(k - 1) - 1.0 / h(k);
    right(k, k + 1) = 1.0 / h(k);
  }
  if (end == SplineEnd::kNatural) {
    left(0, 0) = left(n - 1, n - 1) = 1.0;
  } else {
    left.block(0, 0, 1, 3) << -h(1), h(0) + h(1), -h(0);
    left.block(n - 1, n - 3, 1, 3) << -h(n - 2), h(n - 3) + h(n - 2), -h(n - 3);
  }
  return solve_system(left, right);
}

void check_knots(const ArrayXd& knots) {
  if (knots.size() < 4)
    throw UndeterminedFit(
        fmt::format("cubic spline: {} knots from the data, at least 4 are "
                    "needed (a smaller knot_spacing_K or a wider temperature "
                    "range)",
                    knots.size()));
  for (Index k = 1; k < knots.size(); ++k)
    if (!(knots(k) > knots(k - 1)))
      throw std::invalid_argument(
          fmt::format("cubic spline: knot {} after knot {}: knots must "
                      "increase",
                      knots(k), knots(k - 1)));
}

}  // namespace

ArrayXd CubicSpline::predict(const Eigen::Ref<const ArrayXd>& x) const {
  ArrayXd y(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Piece p = piece_at(knots, x(i));
    y(i) = p.a * values(p.k) + p.b * values(p.k + 1) +
           p.c * second_derivatives(p.k) + p.d * second_derivatives(p.k + 1);
  }
  return y;
}

CubicSpline fit_cubic_spline(const Eigen::Ref<const ArrayXd>& x,
                             const Eigen::Ref<const ArrayXd>& y,
                             const ArrayXd& knots, SplineEnd end) {
  check_knots(knots);
  const MatrixXd S = second_derivative_operator(knots, end);
  MatrixXd design = MatrixXd::Zero(x.size(), knots.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Piece p = piece_at(knots, x(i));
    design(i, p.k) += p.a;
    design(i, p.k + 1) += p.b;
    design.row(i) += p.c * S.row(p.k) + p.d * S.row(p.k + 1);
  }
  const auto [values, rank] = least_squares(design, y.matrix());
  if (rank < knots.size())
    throw UndeterminedFit(
        fmt::format("cubic spline: the {} rows determine the values at only "
                    "{} of the {} knots; a larger knot_spacing_K is needed",
                    x.size(), rank, knots.size()));
  return {knots, values.array(), (S * values).array()};
}

ArrayXd spline_knots(const Eigen::Ref<const ArrayXd>& x, double spacing) {
  std::vector<double> sorted(x.begin(), x.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> knots;
  auto first = sorted.begin();
  while (first != sorted.end()) {
    auto last = first;  // of this group, included
    while (last + 1 != sorted.end() && *(last + 1) - *last <= spacing / 4.0)
      ++last;
    const double width = *last - *first;
    if (width <= spacing / 2.0) {
      double sum = 0.0;
      for (auto value = first; value <= last; ++value) sum += *value - *first;
      knots.push_back(*first + sum / static_cast<double>(last - first + 1));
    } else {
      const int parts = static_cast<int>(std::ceil(width / spacing));
      for (int k = 0; k <= parts; ++k)
        knots.push_back(*first + width * k / parts);
    }
    first = last + 1;
  }
  return array_view(knots);
}

nlohmann::ordered_json CubicSpline::parameters() const {
  return {{"knots_degC", numbers_json(knots)},
          {"values_deg_per_s", numbers_json(values)},
          {"second_derivatives_deg_per_s_per_K2",
           numbers_json(second_derivatives)}};
}

CubicSpline CubicSpline::read(const JsonNode& node, std::size_t) {
  CubicSpline spline{
      read_array(node.at("knots_degC")),
      read_array(node.at("values_deg_per_s")),
      read_array(node.at("second_derivatives_deg_per_s_per_K2"))};
  const Eigen::Index n = spline.knots.size();
  if (n < 4 || spline.values.size() != n ||
      spline.second_derivatives.size() != n)
    node.fail(
        fmt::format("{} knots, {} values and {} second derivatives, must "
                    "be as many of each and at least 4",
                    n, spline.values.size(), spline.second_derivatives.size()));
  if (!(spline.knots.tail(n - 1) > spline.knots.head(n - 1)).all())
    node.at("knots_degC").fail("must increase");
  return spline;
}

void CubicSpline::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"knots", "[degC]", singles(knots)});
  arrays.add({"values", "[deg/s]", singles(values)});
  arrays.add({"seconds", "second derivatives [deg/s/K^2]",
              singles(second_derivatives)});
}

float CubicSpline::firmware_value(const FirmwareArrays& arrays,
                                  std::span<const float> x) const {
  return runtime::spline_at(arrays.data("knots"), arrays.data("values"),
                            arrays.data("seconds"), arrays.count("values"),
                            x[0]);
}

FirmwareCode CubicSpline::firmware_code(std::size_t) const {
  return {{"spline"},
          fmt::format("  return spline_at(knots, values, seconds, {}, x[0]);\n",
                      values.size())};
}

}  // namespace beamgyro::internal
