// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "compensation/bp_network.h"

namespace beamgyro {

/// Samples a block of BatchNetwork has room for; a multiple of kLanes.
constexpr Eigen::Index kBlockSamples = 64;
/// Sums over samples are kept in this many parts, whatever the processor.
constexpr Eigen::Index kLanes = 4;
/// The augmented Jacobian has a multiple of this many columns.
constexpr Eigen::Index kTile = 4;

/// One block of samples. All arrays have kBlockSamples entries a row and are
/// aligned to kLanes doubles; entries from `samples` on up to a multiple of
/// kLanes are evaluated and weigh nothing.
struct SampleBlock {
  double* activations;   // a row per input, then one per hidden neuron
  const double* target;  // one row
  const double* weight;  // one row: 1, or 0 for a place without a sample
  double* error;         // one row: y - target, 0 for a place without a sample
  Eigen::Index samples;
};

/// a_k of every hidden layer and the errors, by equations (2) and (3).
void forward(const std::vector<NetworkLayer>& layers, const double* w,
             const SampleBlock& block);

/// dy/dw of a block that went forward(), a row of `jacobian` per weight in the
/// order of w; `delta` is scratch of two rows per neuron of the widest layer.
void jacobian(const std::vector<NetworkLayer>& layers, const double* w,
              const SampleBlock& block, double* delta, double* jacobian);

/// d2y/dt2 at t = 0 along w + t v, of a block that went forward(), in
/// `curvature` (one row); `scratch` has four rows per neuron of the widest
/// layer.
void second_derivative(const std::vector<NetworkLayer>& layers, const double* w,
                       const double* v, const SampleBlock& block,
                       double* scratch, double* curvature);

/// Adds J^T e of a block that went forward() to `gradient` (one entry per
/// weight) for the row `e`; `delta` as of jacobian().
void add_gradient(const std::vector<NetworkLayer>& layers, const double* w,
                  const SampleBlock& block, const double* e, double* delta,
                  double* gradient);

/// Adds the products of all pairs of the first `rows` rows of `jacobian`, a
/// multiple of kTile, to the lower triangle of `products` (rows x rows).
void add_products(const double* jacobian, Eigen::Index rows,
                  Eigen::Index samples, double* products);

/// tanh(z) of the entries of z, a multiple of kLanes and so aligned, within
/// 5e-16 of std::tanh.
void tanh_in_place(double* z, Eigen::Index entries);

}  // namespace beamgyro
