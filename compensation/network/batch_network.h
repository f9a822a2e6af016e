// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/models/bp_network.h"
#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// Number of samples in a block of BatchNetwork, a multiple of kLanes.
constexpr Eigen::Index kBatchSamples = 64;
/// Number of parts in which sums over samples are kept, on every processor.
constexpr Eigen::Index kLanes = 4;
/// The augmented Jacobian has a multiple of this many columns.
constexpr Eigen::Index kTile = 4;

/// One block of samples. All arrays have kBatchSamples entries in a row and are
/// aligned to kLanes doubles. Entries from `samples` up to the next multiple of
/// kLanes are evaluated with weight 0.
struct SampleBlock {
  double* activations;   // a row per input, then one per hidden neuron
  const double* target;  // one row
  const double* weight;  // one row: 1, or 0 for a place without a sample
  double* error;         // one row: y - target, 0 for a place without a sample
  Eigen::Index samples;
};

/// Computes a_k of every hidden layer and the errors by equations (2) and (3).
void forward(const std::vector<NetworkLayer>& layers, const double* w,
             const SampleBlock& block);

/// Computes dy/dw of a block after forward(), one row of `jacobian` for each
/// weight in the order of w. `delta` is scratch memory of two rows for each
/// neuron of the widest layer.
void jacobian(const std::vector<NetworkLayer>& layers, const double* w,
              const SampleBlock& block, double* delta, double* jacobian);

/// Computes d2y/dt2 at t = 0 along w + t v of a block after forward() and
/// writes it to `curvature` (one row). `scratch` has four rows for each neuron
/// of the widest layer.
void second_derivative(const std::vector<NetworkLayer>& layers, const double* w,
                       const double* v, const SampleBlock& block,
                       double* scratch, double* curvature);

/// Adds J^T e of a block after forward() to `gradient` (one entry for each
/// weight), for the row `e`. `delta` is as in jacobian().
void add_gradient(const std::vector<NetworkLayer>& layers, const double* w,
                  const SampleBlock& block, const double* e, double* delta,
                  double* gradient);

/// Adds the products of all pairs of the first `rows` rows of `jacobian`, a
/// multiple of kTile, to the lower triangle of `products` (rows x rows).
void add_products(const double* jacobian, Eigen::Index rows,
                  Eigen::Index samples, double* products);

/// Replaces the entries of z by tanh(z), within 5e-16 of std::tanh. Their
/// number is a multiple of kLanes, and z is aligned to kLanes doubles.
void tanh_in_place(double* z, Eigen::Index entries);

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
