// SPDX-License-Identifier: MIT
#include "compensation/rate_penalty.h"

#include <algorithm>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInputStep = 1e-3;  // of a scaled input
constexpr Index kBlockRows = 1024;   // J of a block stays in the cache

}  // namespace

RatePenalty::RatePenalty(const BpNetwork& network, const ScaledRows& rows,
                         const TrainOptions& options)
    : network_(network), penalty_(options.rate_penalty) {
  if (!active()) return;
  const Eigen::Map<const Eigen::RowVectorXd> direction(
      options.rate_direction.data(),
      static_cast<Index>(options.rate_direction.size()));
  step_ = kInputStep / direction.norm();
  const Eigen::RowVectorXd move = step_ * direction;
  behind_ = rows.inputs.rowwise() - move.array();
  ahead_ = rows.inputs.rowwise() + move.array();
}

double RatePenalty::value(const VectorXd& w) {
  if (!active()) return 0.0;
  network_.set_weights(w);
  const ArrayXd g =
      (network_.predict(ahead_) - network_.predict(behind_)) / (2.0 * step_);
  return 0.5 * penalty_ * g.square().mean();
}

void RatePenalty::add_to(const VectorXd& w, MatrixXd& matrix,
                         VectorXd& gradient) {
  if (!active()) return;
  network_.set_weights(w);
  const double scale = penalty_ / static_cast<double>(ahead_.rows());
  MatrixXd here, there;
  for (Index first = 0; first < ahead_.rows(); first += kBlockRows) {
    const Index count = std::min(kBlockRows, ahead_.rows() - first);
    const ArrayXd up =
        network_.predict_with_jacobian(ahead_.middleRows(first, count), there);
    const ArrayXd down =
        network_.predict_with_jacobian(behind_.middleRows(first, count), here);
    there = (there - here) / (2.0 * step_);
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(there.transpose(), scale);
    gradient.noalias() +=
        scale * (there.transpose() * ((up - down) / (2.0 * step_)).matrix());
  }
}

}  // namespace beamgyro
