// SPDX-License-Identifier: MIT
#include "compensation/models/takagi_sugeno.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

namespace beamgyro {
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
  const Eigen::VectorXd a =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(terms).solve(
          y.matrix());
  model.consequents = a.reshaped(each, rules).transpose();
  return model;
}

}  // namespace beamgyro
