// SPDX-License-Identifier: MIT
#include "compensation/models/takagi_sugeno.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "compensation/firmware/runtime.h"
#include "compensation/models/parameter_json.h"
#include "linear_algebra/least_squares.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

// Normalised memberships, one column per rule. The exponents are taken about
// the nearest rule's, so that far from all rules one membership is still 1.
ArrayXXd memberships(const TakagiSugeno& model, const ArrayXd& x) {
  ArrayXXd exponent(x.size(), model.centres.size());
  for (Index i = 0; i < model.centres.size(); ++i)
    exponent.col(i) = -0.5 * ((x - model.centres(i)) / model.width).square();
  const ArrayXd nearest = exponent.rowwise().maxCoeff();
  ArrayXd sum = ArrayXd::Zero(x.size());
  for (Index i = 0; i < exponent.cols(); ++i) {
    exponent.col(i) = (exponent.col(i) - nearest).unaryExpr([](double e) {
      return std::exp(e);
    });
    sum += exponent.col(i);
  }
  for (Index i = 0; i < exponent.cols(); ++i) exponent.col(i) /= sum;
  return exponent;
}

}  // namespace

ArrayXd TakagiSugeno::predict(const Eigen::Ref<const ArrayXXd>& x) const {
  const ArrayXXd w = memberships(*this, x.col(0));
  ArrayXd y = ArrayXd::Zero(x.rows());
  for (Index i = 0; i < centres.size(); ++i) {
    ArrayXd line = ArrayXd::Constant(x.rows(), consequents(i, 0));
    for (Index j = 0; j < x.cols(); ++j)
      line += consequents(i, j + 1) * x.col(j);
    y += w.col(i) * line;
  }
  return y;
}

TakagiSugeno fit_takagi_sugeno(const Eigen::Ref<const ArrayXXd>& x,
                               const Eigen::Ref<const ArrayXd>& y, int rules) {
  if (rules < 2 || x.rows() == 0)
    throw std::invalid_argument(
        fmt::format("fuzzy: {} rules over {} rows, must be 2 or more over some",
                    rules, x.rows()));
  TakagiSugeno model;
  model.centres = ArrayXd::LinSpaced(rules, -1.0, 1.0);
  model.width = 1.0 / (rules - 1);
  const ArrayXXd w = memberships(model, x.col(0));
  const Index each = x.cols() + 1;
  Eigen::MatrixXd terms(x.rows(), rules * each);
  for (Index i = 0; i < rules; ++i) {
    terms.col(i * each) = w.col(i).matrix();
    for (Index j = 0; j < x.cols(); ++j)
      terms.col(i * each + j + 1) = (w.col(i) * x.col(j)).matrix();
  }
  const Eigen::VectorXd a = least_norm_solution(terms, y.matrix());
  model.consequents = a.reshaped(each, rules).transpose();
  return model;
}

nlohmann::ordered_json TakagiSugeno::parameters() const {
  return {{"centres", numbers_json(centres)},
          {"width", finite_json(width)},
          {"consequents", rows_json(consequents)}};
}

TakagiSugeno TakagiSugeno::read(const JsonNode& node, std::size_t inputs) {
  TakagiSugeno fuzzy{
      read_array(node.at("centres")), read_positive(node.at("width")), {}};
  const std::size_t rules = node.at("consequents").elements().size();
  if (rules == 0 || fuzzy.centres.size() != static_cast<Index>(rules))
    node.at("consequents")
        .fail(fmt::format("{} rules, must be one for each of the {} centres",
                          rules, fuzzy.centres.size()));
  fuzzy.consequents =
      read_matrix(node.at("consequents"), static_cast<Index>(inputs) + 1);
  return fuzzy;
}

void TakagiSugeno::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"centres", "of x[0]", singles(centres)});
  arrays.add({"width", "", {single(width)}});
  const Eigen::MatrixXd rows = consequents.transpose();
  arrays.add(
      {"rules", "constant and slopes of each", singles(rows.reshaped())});
}

float TakagiSugeno::firmware_value(const FirmwareArrays& arrays,
                                   std::span<const float> x) const {
  return runtime::fuzzy_of(arrays.data("centres"), arrays.values("width")[0],
                           arrays.data("rules"), arrays.count("centres"),
                           static_cast<int>(x.size()), x.data());
}

FirmwareCode TakagiSugeno::firmware_code(std::size_t inputs) const {
  return {
      {"exp", "fuzzy"},
      fmt::format("  return fuzzy_of(centres, width[0], rules, {}, {}, x);\n",
                  centres.size(), inputs)};
}

}  // namespace beamgyro::internal
