// SPDX-License-Identifier: MIT
#include "compensation/methods/radial_basis.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "compensation/firmware/runtime.h"
#include "compensation/methods/bias_model.h"
#include "compensation/methods/method_inputs.h"
#include "compensation/models/parameter_json.h"
#include "linear_algebra/least_squares.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

ArrayXd squared_distances(const Eigen::Ref<const Eigen::ArrayXXd>& x,
                          const Eigen::RowVectorXd& centre) {
  return (x.matrix().rowwise() - centre).rowwise().squaredNorm().array();
}

// Points far from each other that are spread over all of them.
MatrixXd spread_centres(const Eigen::Ref<const Eigen::ArrayXXd>& x, int count) {
  Index next = 0;
  squared_distances(x, x.matrix().colwise().mean()).minCoeff(&next);
  MatrixXd centres = x.row(next).matrix();
  ArrayXd nearest = squared_distances(x, centres.row(0));
  while (centres.rows() < count && nearest.maxCoeff(&next) > 0.0) {
    centres.conservativeResize(centres.rows() + 1, Eigen::NoChange);
    centres.bottomRows(1) = x.row(next).matrix();
    nearest = nearest.min(squared_distances(x, centres.bottomRows(1)));
  }
  return centres;
}

// Of a centre from the nearest other one.
double mean_distance(const MatrixXd& centres) {
  double sum = 0.0;
  for (Index i = 0; i < centres.rows(); ++i) {
    ArrayXd squares = squared_distances(centres.array(), centres.row(i));
    squares(i) = squares.maxCoeff();
    sum += std::sqrt(squares.minCoeff());
  }
  return sum / static_cast<double>(centres.rows());
}

// 1, x_0, x_1, ... and the bells, one row per point.
MatrixXd columns_of(const Eigen::Ref<const Eigen::ArrayXXd>& x,
                    const MatrixXd& centres, double width) {
  MatrixXd columns(x.rows(), 1 + x.cols() + centres.rows());
  columns.col(0).setOnes();
  columns.middleCols(1, x.cols()) = x.matrix();
  for (Index i = 0; i < centres.rows(); ++i)
    columns.col(1 + x.cols() + i) =
        (squared_distances(x, centres.row(i)) / (-2.0 * width * width)).exp();
  return columns;
}

double sharpness(double width) { return 1.0 / (2.0 * width * width); }

}  // namespace

ArrayXd RadialBasis::predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  ArrayXd y = ArrayXd::Constant(x.rows(), plane(0));
  for (Index j = 0; j < x.cols(); ++j) y += plane(j + 1) * x.col(j);
  for (Index i = 0; i < centres.rows(); ++i) {
    ArrayXd square = ArrayXd::Zero(x.rows());
    for (Index j = 0; j < x.cols(); ++j)
      square += (x.col(j) - centres(i, j)).square();
    y += weights(i) * (-sharpness(width) * square).exp();
  }
  return y;
}

RadialBasis fit_radial_basis(const Eigen::Ref<const Eigen::ArrayXXd>& x,
                             const Eigen::Ref<const ArrayXd>& y, int count,
                             double width_share, double ridge) {
  RadialBasis fitted;
  fitted.centres = spread_centres(x, count);
  if (squared_distances(x, x.row(0).matrix()).maxCoeff() == 0.0)
    throw std::invalid_argument(
        "all training rows have the same inputs; radial bases need rows where "
        "they vary");
  fitted.width =
      width_share *
      (fitted.centres.rows() > 1 ? mean_distance(fitted.centres) : 1.0);
  const MatrixXd columns = columns_of(x, fitted.centres, fitted.width);
  const Index bells = fitted.centres.rows(), planes = columns.cols() - bells;
  // Rows that weigh the weights, below those of the points.
  MatrixXd system = MatrixXd::Zero(columns.rows() + bells, columns.cols());
  system.topRows(columns.rows()) = columns;
  system.bottomRightCorner(bells, bells)
      .diagonal()
      .setConstant(std::sqrt(ridge * static_cast<double>(x.rows())));
  Eigen::VectorXd target = Eigen::VectorXd::Zero(system.rows());
  target.head(y.size()) = y.matrix();
  const Eigen::VectorXd solution = least_norm_solution(system, target);
  fitted.plane = solution.head(planes);
  fitted.weights = solution.tail(bells);
  return fitted;
}

nlohmann::ordered_json RadialBasis::parameters() const {
  return {{"centres", rows_json(centres)},
          {"width", finite_json(width)},
          {"plane", numbers_json(plane)},
          {"weights", numbers_json(weights)}};
}

RadialBasis RadialBasis::read(const JsonNode& node, std::size_t inputs) {
  RadialBasis read;
  const auto columns = static_cast<Index>(inputs);
  read.centres =
      read_matrix(node.at("centres"), columns, ", one for each of the inputs");
  read.width = read_positive(node.at("width"));
  read.plane = read_array(node.at("plane"), columns + 1).matrix();
  read.weights = read_array(node.at("weights")).matrix();
  if (read.weights.size() != read.centres.rows())
    node.at("weights").fail(
        fmt::format("{} weights, must be one for each of the {} centres",
                    read.weights.size(), read.centres.rows()));
  return read;
}

void RadialBasis::put_arrays(FirmwareArrays& arrays) const {
  const MatrixXd rows = centres.transpose();
  arrays.add({"centres", "coordinates of each", singles(rows.reshaped())});
  arrays.add({"sharpness", "1 / (2 width^2)", {single(sharpness(width))}});
  arrays.add({"plane", "constant and slopes", singles(plane)});
  arrays.add({"weights", "of the centres", singles(weights)});
}

float RadialBasis::firmware_value(const FirmwareArrays& arrays,
                                  std::span<const float> x) const {
  const float* centre = arrays.data("centres");
  const float* slopes = arrays.data("plane");
  const float sharp = arrays.values("sharpness")[0];
  float y = slopes[0];
  for (std::size_t j = 0; j < x.size(); ++j) y = y + slopes[j + 1] * x[j];
  for (const float weight : arrays.values("weights")) {
    float square = 0.0f;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const float z = x[j] - centre[j];
      square = square + z * z;
    }
    y = y + weight * runtime::exp_minus(sharp * square);
    centre += x.size();
  }
  return y;
}

FirmwareCode RadialBasis::firmware_code(std::size_t inputs) const {
  return {
      {"exp"},
      fmt::format("  float y = plane[0];\n"
                  "  int i, j;\n"
                  "  for (j = 0; j < {0}; ++j) y = y + plane[j + 1] * x[j];\n"
                  "  for (i = 0; i < {1}; ++i) {{\n"
                  "    float square = 0.0f;\n"
                  "    for (j = 0; j < {0}; ++j) {{\n"
                  "      const float z = x[j] - centres[i * {0} + j];\n"
                  "      square = square + z * z;\n"
                  "    }}\n"
                  "    y = y + weights[i] * exp_minus(sharpness[0] * square);\n"
                  "  }}\n"
                  "  return y;\n",
                  inputs, weights.size())};
}

RadialBasisSpec RadialBasisSpec::read(MethodSource& source) {
  const ConfigTable table = source.table(kName);
  RadialBasisSpec spec;
  spec.centres =
      static_cast<int>(table.integer_or("centres", spec.centres, 1, 1000));
  spec.width_share =
      table.number_or("width_share", spec.width_share, positive());
  spec.ridge = table.number_or("ridge", spec.ridge, positive());
  return spec;
}

std::string RadialBasisSpec::method_name() const {
  return fmt::format("radial bases about {} centres", centres);
}

Fit RadialBasisSpec::fit(const FitTask& task) const {
  const std::vector<Scale> scales = scales_of(task);
  return model_of(
      scales, fit_radial_basis(scaled(task.rows.inputs, scales), task.rows.bias,
                               centres, width_share, ridge));
}

}  // namespace beamgyro::internal
