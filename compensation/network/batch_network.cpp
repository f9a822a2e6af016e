// SPDX-License-Identifier: MIT
#include "compensation/network/batch_network.h"

#include <algorithm>

#include "parallel/work_queue.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kMaxChunks = 16;    // no more threads are of use
constexpr Index kChunkBlocks = 16;  // fewer are not worth a thread
constexpr Index kBookRows = 3;      // error, target and weight of a block

Index rounded_up(Index count, Index multiple) {
  return (count + multiple - 1) / multiple * multiple;
}

}  // namespace

BatchNetwork::BatchNetwork(const std::vector<int>& layer_sizes,
                           const ScaledRows& rows, int threads)
    : layers_(layers_of(layer_sizes)),
      threads_(threads),
      rows_(rows.size()),
      columns_(rounded_up(layers_.back().biases + 2, kTile)) {
  for (const NetworkLayer& layer : layers_) {
    neurons_ += layer.in;
    widest_ = std::max(widest_, layer.out);
  }
  const Index blocks = rounded_up(rows_, kBatchSamples) / kBatchSamples;
  data_ = Values(blocks * (neurons_ + kBookRows) * kBatchSamples);
  for (Index k = 0; k < blocks; ++k) {
    const SampleBlock b = block(k);
    const Index first = k * kBatchSamples;
    for (Index i = 0; i < rows.inputs.cols(); ++i)
      std::copy_n(rows.inputs.col(i).data() + first, b.samples,
                  b.activations + i * kBatchSamples);
    double* target = b.error + kBatchSamples;
    std::copy_n(rows.target.data() + first, b.samples, target);
    std::fill_n(target + kBatchSamples, b.samples, 1.0);
  }
  const Index chunks = std::clamp(blocks / kChunkBlocks, Index{1}, kMaxChunks);
  for (Index c = 0; c < chunks; ++c)
    chunks_.push_back({blocks * c / chunks, blocks * (c + 1) / chunks,
                       Values(columns_ * kBatchSamples),
                       Values((4 * widest_ + 1) * kBatchSamples),
                       Values(columns_ * columns_)});
}

SampleBlock BatchNetwork::block(Index k) {
  double* first = data_.data() + k * (neurons_ + kBookRows) * kBatchSamples;
  double* error = first + neurons_ * kBatchSamples;
  return {first, error + kBatchSamples, error + 2 * kBatchSamples, error,
          std::min(kBatchSamples, rows_ - k * kBatchSamples)};
}

// Calls f(chunk) for every chunk, on the threads there are.
template <class F>
void BatchNetwork::for_each_chunk(const F& f) {
  for_each_task(chunks_.size(), static_cast<std::size_t>(threads_),
                [&](std::size_t c, std::size_t) { f(chunks_[c]); });
}

double BatchNetwork::sum_of_squares(const VectorXd& w) {
  w_ = w;
  for_each_chunk([&](Chunk& chunk) {
    chunk.squares = 0.0;
    for (Index k = chunk.first; k < chunk.last; ++k) {
      const SampleBlock b = block(k);
      forward(layers_, w_.data(), b);
      chunk.squares +=
          Eigen::Map<const VectorXd>(b.error, b.samples).squaredNorm();
    }
  });
  double squares = 0.0;
  for (const Chunk& chunk : chunks_) squares += chunk.squares;
  return squares;
}

void BatchNetwork::normal_equations(Eigen::MatrixXd& matrix,
                                    VectorXd& gradient) {
  for_each_chunk([&](Chunk& chunk) {
    double* products = chunk.products.data();
    std::fill_n(products, columns_ * columns_, 0.0);
    for (Index k = chunk.first; k < chunk.last; ++k) {
      const SampleBlock b = block(k);
      double* rows = chunk.jacobian.data();
      jacobian(layers_, w_.data(), b, chunk.scratch.data(), rows);
      std::copy_n(b.error, kBatchSamples, rows + w_.size() * kBatchSamples);
      add_products(rows, columns_, b.samples, products);
    }
  });
  // Row by row below the diagonal, so column by column above it.
  using Map = Eigen::Map<const Eigen::MatrixXd>;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns_, columns_);
  for (Chunk& chunk : chunks_)
    sum += Map(chunk.products.data(), columns_, columns_);
  const Index n = w_.size();
  matrix = sum.topLeftCorner(n, n).transpose();
  gradient = sum.col(n).head(n);
}

VectorXd BatchNetwork::curvature(const VectorXd& v) {
  for_each_chunk([&](Chunk& chunk) {
    double* sum = chunk.products.data();
    double* scratch = chunk.scratch.data();
    double* bend = scratch + 4 * widest_ * kBatchSamples;
    std::fill_n(sum, columns_, 0.0);
    for (Index k = chunk.first; k < chunk.last; ++k) {
      const SampleBlock b = block(k);
      second_derivative(layers_, w_.data(), v.data(), b, scratch, bend);
      add_gradient(layers_, w_.data(), b, bend, scratch, sum);
    }
  });
  VectorXd product = VectorXd::Zero(w_.size());
  for (Chunk& chunk : chunks_)
    product += Eigen::Map<const VectorXd>(chunk.products.data(), w_.size());
  return product;
}

}  // namespace beamgyro::internal
