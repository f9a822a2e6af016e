// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/network/batch_kernels.h"
#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// Evaluates a BP network over all rows of a training set, for the trainers.
/// Its outputs are those of BpNetwork except for rounding. The division of the
/// rows into chunks depends on their number alone, and the sums of the chunks
/// are added in order, so results do not depend on `threads`.
class BatchNetwork {
 public:
  BatchNetwork(const std::vector<int>& layer_sizes, const ScaledRows& rows,
               int threads);

  /// Returns Σ e^2 over the rows at weights w, e = y - target. Keeps the
  /// outputs of all neurons.
  double sum_of_squares(const Eigen::VectorXd& w);

  /// Computes J^T J (lower triangle) and J^T e with J = dy/dw, at the weights
  /// of the last sum_of_squares().
  void normal_equations(Eigen::MatrixXd& matrix, Eigen::VectorXd& gradient);

  /// Returns J^T d2y/dt2 at t = 0 along w + t v, at the same weights.
  Eigen::VectorXd curvature(const Eigen::VectorXd& v);

 private:
  // Doubles with the alignment that the kernels need.
  struct alignas(kLanes * sizeof(double)) Lanes {
    double value[kLanes];
  };
  struct Values {
    std::vector<Lanes> lanes;
    explicit Values(Eigen::Index size = 0)
        : lanes(static_cast<std::size_t>((size + kLanes - 1) / kLanes)) {}
    double* data() { return lanes.data()->value; }
  };

  // Blocks [first, last), and the results of their evaluation.
  struct Chunk {
    Eigen::Index first, last;
    Values jacobian, scratch, products;
    double squares = 0.0;
  };

  template <class F>
  void for_each_chunk(const F& f);
  SampleBlock block(Eigen::Index k);

  std::vector<NetworkLayer> layers_;
  int threads_;
  Eigen::Index rows_, columns_;
  Eigen::Index neurons_ = 0;  // with the inputs, without the output
  Eigen::Index widest_ = 1;   // neurons of the widest layer above the inputs
  Eigen::VectorXd w_;
  Values data_;
  std::vector<Chunk> chunks_;
};

}  // namespace beamgyro::internal
