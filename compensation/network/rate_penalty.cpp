// SPDX-License-Identifier: MIT
#include "compensation/network/rate_penalty.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kJacobianBlockRows = 1024;  // J of a block stays in the cache

}  // namespace

RatePenalty::RatePenalty(const BpNetwork& network, const ScaledRows& rows,
                         const TrainOptions& options)
    : network_(network), penalty_(options.rate_penalty) {
  if (!active()) return;
  const Eigen::Map<const Eigen::RowVectorXd> direction(
      options.rate_direction.data(),
      static_cast<Index>(options.rate_direction.size()));
  const double length = direction.norm();
  if (!(length > 0.0))
    throw std::invalid_argument(
        "a penalty on the rate needs an input that changes with it");
  here_ = there_ = rows.inputs;
  inverse_step_.resize(rows.size());
  for (Index k = 0; k < rows.size(); ++k) {
    const double step =
        kPenaltySteps[static_cast<std::size_t>(k) % std::size(kPenaltySteps)];
    there_.row(k) += (step / length) * direction.array();
    inverse_step_(k) = length / step;
  }
}

double RatePenalty::value(const VectorXd& w) {
  if (!active()) return 0.0;
  network_.set_weights(w);
  const ArrayXd g =
      (network_.predict(there_) - network_.predict(here_)) * inverse_step_;
  return 0.5 * penalty_ * g.square().mean();
}

void RatePenalty::add_to(const VectorXd& w, MatrixXd& matrix,
                         VectorXd& gradient) {
  if (!active()) return;
  network_.set_weights(w);
  const double scale = penalty_ / static_cast<double>(here_.rows());
  MatrixXd from, to;
  for (Index first = 0; first < here_.rows(); first += kJacobianBlockRows) {
    const Index count = std::min(kJacobianBlockRows, here_.rows() - first);
    const auto per_step = inverse_step_.segment(first, count);
    const ArrayXd before =
        network_.predict_with_jacobian(here_.middleRows(first, count), from);
    const ArrayXd after =
        network_.predict_with_jacobian(there_.middleRows(first, count), to);
    to = per_step.matrix().asDiagonal() * (to - from);
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(to.transpose(), scale);
    gradient.noalias() +=
        scale * (to.transpose() * ((after - before) * per_step).matrix());
  }
}

}  // namespace beamgyro::internal
