// SPDX-License-Identifier: MIT
#include "compensation/methods/population_equations.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "compensation/methods/population_own.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of curve number `curve`; 0 is the bias.
PointEquations equations(const Population& p, const MatrixXd& modes,
                         Index curve, const ArrayXd& T, const ArrayXd& measured,
                         double noise) {
  const auto at_rows = [&](const VectorXd& curves) -> ArrayXd {
    const ArrayXd own = curves.segment(curve * p.grid(), p.grid());
    return bias_curve(p, own).predict(T);
  };
  PointEquations e{MatrixXd(T.size(), modes.cols()), VectorXd(T.size())};
  for (Index m = 0; m < modes.cols(); ++m)
    e.H.col(m) = at_rows(modes.col(m)) / noise;
  e.y = (measured - at_rows(p.mean)) / noise;
  return e;
}

Index curve_number(const Population& population, const Input& input) {
  const auto found =
      std::find(population.channels.begin(), population.channels.end(), input);
  if (found == population.channels.end())
    throw std::invalid_argument(fmt::format(
        "the population does not know the input \"{}\"", input_name(input)));
  return 1 + (found - population.channels.begin());
}

// Means of the rows within kPointWidth of each other.
struct Points {
  ArrayXd temperature, bias;
  Eigen::ArrayXXd inputs;
};
Points points_of(const TrainingRows& rows) {
  std::vector<Index> order(static_cast<std::size_t>(rows.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return rows.temperature(a) < rows.temperature(b);
  });
  std::vector<std::vector<Index>> groups;
  for (const Index k : order) {
    if (groups.empty() ||
        rows.temperature(k) - rows.temperature(groups.back().front()) >=
            kPointWidth)
      groups.emplace_back();
    groups.back().push_back(k);
  }
  const auto count = static_cast<Index>(groups.size());
  Points points{ArrayXd(count), ArrayXd(count),
                Eigen::ArrayXXd(count, rows.inputs.cols())};
  for (Index k = 0; k < count; ++k) {
    const std::vector<Index>& group = groups[static_cast<std::size_t>(k)];
    points.temperature(k) = rows.temperature(group).mean();
    points.bias(k) = rows.bias(group).mean();
    for (Index i = 0; i < rows.inputs.cols(); ++i)
      points.inputs(k, i) = rows.inputs.col(i)(group).mean();
  }
  return points;
}

}  // namespace

PointEquations point_equations(const Population& population,
                               const std::vector<Input>& inputs,
                               const TrainingRows& rows,
                               const PointNoise& noise) {
  const RowMask near = rows.beyond_range <= kPointReach;
  const Points points = points_of(near.all() ? rows : selected(rows, near));
  const Index count = points.bias.size();
  const auto curves = static_cast<Index>(inputs.size());
  const MatrixXd modes = all_modes(population);
  PointEquations all{MatrixXd(curves * count, modes.cols()),
                     VectorXd(curves * count)};
  for (Index i = 0; i < curves && count > 0; ++i) {
    const Index curve =
        i == 0 ? 0
               : curve_number(population, inputs[static_cast<std::size_t>(i)]);
    const ArrayXd measured =
        i == 0 ? points.bias : ArrayXd(points.inputs.col(i));
    const PointEquations own =
        equations(population, modes, curve, points.temperature, measured,
                  point_noise_of(population, curve, noise));
    all.H.middleRows(i * count, count) = own.H;
    all.y.segment(i * count, count) = own.y;
  }
  return all;
}

}  // namespace beamgyro::internal
