// SPDX-License-Identifier: MIT
#include "planning/soak_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compensation/models/array_view.h"

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kRangeStep = 1.0;   // [K], over which the residual is averaged
constexpr double kLeastStep = 1e-3;  // [K], where the population ends

}  // namespace

SoakModel::SoakModel(Population population, SensorOfChamber sensor,
                     const SoakModelOptions& options)
    : population_(std::move(population)),
      sensor_(std::move(sensor)),
      options_(options) {
  if (modes() == 0)
    throw std::invalid_argument(
        "the devices of the population are all alike: there is nothing that a "
        "soak could tell; expected a population whose devices differ");
  const Index grid = population_.grid();
  for (Index curve = 0; curve < rows_per_soak(); ++curve)
    for (const auto& mode : population_.modes.colwise())
      modes_.push_back(
          bias_curve(population_, mode.segment(curve * grid, grid).array()));
  const MatrixXd bias = values(0, known_sensor(range_grid()));
  weight_ = bias.transpose() * bias / static_cast<double>(bias.rows());
}

// One column for each mode, one row for each temperature of the sensor.
MatrixXd SoakModel::values(Index curve, const ArrayXd& sensor) const {
  MatrixXd found(sensor.size(), modes());
  for (Index m = 0; m < modes(); ++m)
    found.col(m) =
        modes_[static_cast<std::size_t>(curve * modes() + m)].predict(sensor);
  return found;
}

ArrayXd SoakModel::range_grid() const {
  const auto [lowest, highest] = options_.range;
  const auto steps =
      static_cast<Index>(std::ceil((highest - lowest) / kRangeStep - 1e-9));
  return ArrayXd::LinSpaced(steps + 1, lowest, highest);
}

bool SoakModel::reaches(double chamber) const {
  const double sensor = sensor_(ArrayXd::Constant(1, chamber))(0);
  const auto [lowest, highest] = population_.range();
  return sensor >= lowest - kReach && sensor <= highest + kReach;
}

ArrayXd SoakModel::known_sensor(const ArrayXd& chamber) const {
  const auto [lowest, highest] = population_.range();
  const ArrayXd sensor = sensor_(chamber);
  for (Index k = 0; k < sensor.size(); ++k)
    if (!(sensor(k) >= lowest - kReach && sensor(k) <= highest + kReach))
      throw std::invalid_argument(fmt::format(
          "in a chamber at {:g} degC the sensor shows {:.2f} degC, and the "
          "population knows {:.2f} to {:.2f} degC; expected temperatures of "
          "the chamber for which it lies within these",
          chamber(k), sensor(k), lowest, highest));
  return sensor.max(lowest).min(highest);
}

Index SoakModel::rows_per_soak() const {
  return options_.bias_only
             ? 1
             : 1 + static_cast<Index>(population_.channels.size());
}

MatrixXd SoakModel::equations(const std::vector<double>& chamber) const {
  const Index rows = rows_per_soak();
  MatrixXd H(rows * static_cast<Index>(chamber.size()), modes());
  if (chamber.empty()) return H;
  const ArrayXd T = known_sensor(array_view(chamber));
  for (Index curve = 0; curve < rows; ++curve) {
    const double noise = curve == 0 ? options_.noise.bias
                                    : options_.noise.channel_share *
                                          curve_spread(population_, curve);
    const MatrixXd own = values(curve, T) / noise;
    for (Index k = 0; k < own.rows(); ++k) H.row(k * rows + curve) = own.row(k);
  }
  return H;
}

double SoakModel::rms_slope() const {
  const ArrayXd T = known_sensor(range_grid());
  const ArrayXd mean =
      bias_curve(population_, population_.mean.head(population_.grid()).array())
          .predict(T);
  const MatrixXd modes_of_bias = values(0, T);
  double squares = 0.0;
  for (Index k = 1; k < T.size(); ++k)
    squares +=
        ((modes_of_bias.row(k) - modes_of_bias.row(k - 1)).squaredNorm() +
         std::pow(mean(k) - mean(k - 1), 2)) /
        std::max(T(k) - T(k - 1), kLeastStep) / (T(T.size() - 1) - T(0));
  return std::sqrt(squares);
}

}  // namespace beamgyro
