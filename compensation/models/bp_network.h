// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compensation/models/bias_function.h"
#include "random/random_stream.h"

namespace beamgyro::internal {

/// Positions of the weights of one layer in the flat vector: W begins at
/// `weights`, column by column, and b at `biases`.
struct NetworkLayer {
  Eigen::Index in, out, weights, biases;
  bool last;
};

std::vector<NetworkLayer> layers_of(const std::vector<int>& layer_sizes);

/// Fully connected network of the paper, equations (2) and (3): tansig hidden
/// layers, one purelin output,
///
///   a_0 = x,   a_k = tanh(W_k a_{k-1} + b_k),   y = W_n a_{n-1} + b_n
///
/// with tansig(n) = 2 / (1 + exp(-2 n)) - 1 = tanh(n). All weights are in one
/// flat vector: W_1 column by column, b_1, W_2, b_2, ... Inputs and output are
/// scaled to order one. There is one sample in each row. The answer to a sample
/// does not depend, to the last bit, on the samples that are evaluated with it.
class BpNetwork {
 public:
  /// Makes a network with zero weights; `layer_sizes` = {inputs, hidden..., 1}.
  /// Throws std::invalid_argument for fewer than two layers, a size below one
  /// or more than one output.
  explicit BpNetwork(std::vector<int> layer_sizes);

  const std::vector<int>& layer_sizes() const { return layer_sizes_; }
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Throws std::invalid_argument for another number of weights.
  void set_weights(const Eigen::VectorXd& weights);

  /// Sets initial weights after Nguyen and Widrow (IJCNN 1990): the rows of a
  /// hidden W have length 0.7 S^(1/R) in random directions, its biases spread
  /// the transitions evenly over [-1, 1]; output weights uniform in (-0.5,
  /// 0.5).
  void randomise(RandomStream& random);

  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXXd>& x) const;

  static constexpr const char* kKind = "bp";
  static constexpr InputUse kInputUse = InputUse::kAny;
  nlohmann::ordered_json parameters() const;
  static BpNetwork read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;

  /// Returns the output of every sample, and dy/dw in `jacobian` by
  /// back-propagation: one row for each sample and one column for each weight.
  Eigen::ArrayXd predict_with_jacobian(
      const Eigen::Ref<const Eigen::ArrayXXd>& x,
      Eigen::MatrixXd& jacobian) const;

  /// Returns the output of every sample, and d(1/2 Σ e^2)/dw in `gradient` for
  /// the errors e = y - target, equation (4).
  Eigen::ArrayXd predict_with_gradient(
      const Eigen::Ref<const Eigen::ArrayXXd>& x,
      const Eigen::Ref<const Eigen::ArrayXd>& target,
      Eigen::VectorXd& gradient) const;

 private:
  std::vector<int> layer_sizes_;
  Eigen::VectorXd weights_;
};

}  // namespace beamgyro::internal
