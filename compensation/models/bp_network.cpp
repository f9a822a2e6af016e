// SPDX-License-Identifier: MIT
#include "compensation/models/bp_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compensation/firmware/runtime.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::VectorXd;

Index weight_count(const std::vector<int>& sizes) {
  const NetworkLayer last = layers_of(sizes).back();
  return last.biases + last.out;
}

// Sums in the order of the inputs, element by element, so that a sample gives
// the same bits alone and within any block.
ArrayXXd layer_output(const NetworkLayer& layer, const VectorXd& w,
                      const Eigen::Ref<const ArrayXXd>& a) {
  ArrayXXd z(a.rows(), layer.out);
  for (Index o = 0; o < layer.out; ++o) {
    z.col(o).setConstant(w(layer.biases + o));
    for (Index i = 0; i < layer.in; ++i)
      z.col(o) += w(layer.weights + i * layer.out + o) * a.col(i);
  }
  if (!layer.last) z = z.unaryExpr([](double n) { return std::tanh(n); });
  return z;
}

// dy/dz of the layer below from dy/dz of `layer`, `a` being the output of the
// layer below.
ArrayXXd propagate_back(const NetworkLayer& layer, const VectorXd& w,
                        const ArrayXXd& delta, const ArrayXXd& a) {
  ArrayXXd below = ArrayXXd::Zero(a.rows(), layer.in);
  for (Index i = 0; i < layer.in; ++i) {
    for (Index o = 0; o < layer.out; ++o)
      below.col(i) += w(layer.weights + i * layer.out + o) * delta.col(o);
    below.col(i) *= 1.0 - a.col(i).square();
  }
  return below;
}

double uniform_within(double bound, RandomStream& random) {
  return bound * (2.0 * random.uniform() - 1.0);
}

constexpr int kWrittenOut = 8;

// The weighted sum of one neuron: few terms are written out, so that no loop
// over them costs more than they do.
std::string sum_text(std::size_t layer, int terms, const std::string& from) {
  std::string text = fmt::format(
      "    const float *w = weights_{0} + o * {1};\n"
      "    float z = biases_{0}[o];\n",
      layer, terms);
  if (terms > kWrittenOut)
    return text +
           fmt::format("    for (i = 0; i < {}; ++i) z = z + w[i] * {}[i];\n",
                       terms, from);
  for (int i = 0; i < terms; ++i)
    text += fmt::format("    z = z + w[{0}] * {1}[{0}];\n", i, from);
  return text;
}

// Body of the function that evaluates a network of these layer sizes.
std::string network_lines(const std::vector<int>& sizes) {
  const std::size_t output = sizes.size() - 1;
  std::string arrays, text, from = "x";
  for (std::size_t k = 1; k < output; ++k) {
    text += fmt::format("  for (o = 0; o < {}; ++o) {{\n", sizes[k]) +
            sum_text(k, sizes[k - 1], from);
    from = fmt::format("a{}", k);
    if (k + 1 < output) {
      arrays += fmt::format("  float {}[{}];\n", from, sizes[k]);
      text += fmt::format("    {}[o] = tanh_of(z);\n  }}\n", from);
    } else {
      text += fmt::format("    y = y + weights_{}[o] * tanh_of(z);\n  }}\n",
                          output);
    }
  }
  if (output == 1)
    text = fmt::format(
        "  for (o = 0; o < {}; ++o) y = y + weights_1[o] * x[o];\n", sizes[0]);
  const bool loops = std::any_of(sizes.begin(), sizes.end() - 2,
                                 [](int terms) { return terms > kWrittenOut; });
  return fmt::format("  float y = biases_{}[0];\n{}  int {}o;\n", output,
                     arrays, loops ? "i, " : "") +
         text + "  return y;\n";
}

}  // namespace

std::vector<NetworkLayer> layers_of(const std::vector<int>& sizes) {
  std::vector<NetworkLayer> layers;
  Index offset = 0;
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const Index in = sizes[k - 1], out = sizes[k];
    layers.push_back(
        {in, out, offset, offset + in * out, k + 1 == sizes.size()});
    offset += (in + 1) * out;
  }
  return layers;
}

BpNetwork::BpNetwork(std::vector<int> layer_sizes)
    : layer_sizes_(std::move(layer_sizes)) {
  if (layer_sizes_.size() < 2)
    throw std::invalid_argument(
        "bp network: needs an input and an output layer");
  for (const int size : layer_sizes_)
    if (size < 1)
      throw std::invalid_argument(fmt::format(
          "bp network: layer of {} neurons, must be at least 1", size));
  if (layer_sizes_.back() != 1)
    throw std::invalid_argument(fmt::format(
        "bp network: {} outputs, must be 1 (the bias)", layer_sizes_.back()));
  weights_.setZero(weight_count(layer_sizes_));
}

void BpNetwork::set_weights(const VectorXd& weights) {
  if (weights.size() != weights_.size())
    throw std::invalid_argument(
        fmt::format("bp network: {} weights, its layers need {}",
                    weights.size(), weights_.size()));
  weights_ = weights;
}

void BpNetwork::randomise(RandomStream& random) {
  for (const NetworkLayer& layer : layers_of(layer_sizes_)) {
    auto W = weights_.segment(layer.weights, layer.in * layer.out)
                 .reshaped(layer.out, layer.in);
    auto b = weights_.segment(layer.biases, layer.out);
    if (layer.last) {
      for (double& w : W.reshaped()) w = uniform_within(0.5, random);
      b(0) = uniform_within(0.5, random);
      continue;
    }
    const double length = 0.7 * std::pow(static_cast<double>(layer.out),
                                         1.0 / static_cast<double>(layer.in));
    for (Index o = 0; o < layer.out; ++o) {
      for (Index i = 0; i < layer.in; ++i)
        W(o, i) = uniform_within(1.0, random);
      W.row(o) *= length / W.row(o).norm();
      const double place = layer.out == 1
                               ? 0.0
                               : 2.0 * static_cast<double>(o) /
                                         static_cast<double>(layer.out - 1) -
                                     1.0;
      b(o) = length * place * (W(o, 0) < 0.0 ? -1.0 : 1.0);
    }
  }
}

ArrayXd BpNetwork::predict(const Eigen::Ref<const ArrayXXd>& x) const {
  ArrayXXd a = x;
  for (const NetworkLayer& layer : layers_of(layer_sizes_))
    a = layer_output(layer, weights_, a);
  return a.col(0);
}

ArrayXd BpNetwork::predict_with_jacobian(const Eigen::Ref<const ArrayXXd>& x,
                                         Eigen::MatrixXd& jacobian) const {
  const std::vector<NetworkLayer> layers = layers_of(layer_sizes_);
  std::vector<ArrayXXd> a{x};
  for (const NetworkLayer& layer : layers)
    a.push_back(layer_output(layer, weights_, a.back()));

  jacobian.resize(x.rows(), weights_.size());
  ArrayXXd delta = ArrayXXd::Ones(x.rows(), 1);
  for (std::size_t k = layers.size(); k-- > 0;) {
    const NetworkLayer& layer = layers[k];
    for (Index i = 0; i < layer.in; ++i)
      for (Index o = 0; o < layer.out; ++o)
        jacobian.col(layer.weights + i * layer.out + o) =
            (delta.col(o) * a[k].col(i)).matrix();
    jacobian.middleCols(layer.biases, layer.out) = delta.matrix();
    if (k > 0) delta = propagate_back(layer, weights_, delta, a[k]);
  }
  return a.back().col(0);
}

ArrayXd BpNetwork::predict_with_gradient(
    const Eigen::Ref<const ArrayXXd>& x,
    const Eigen::Ref<const ArrayXd>& target, VectorXd& gradient) const {
  const std::vector<NetworkLayer> layers = layers_of(layer_sizes_);
  std::vector<ArrayXXd> a{x};
  for (const NetworkLayer& layer : layers)
    a.push_back(layer_output(layer, weights_, a.back()));

  gradient.resize(weights_.size());
  ArrayXXd delta = a.back().col(0) - target;
  for (std::size_t k = layers.size(); k-- > 0;) {
    const NetworkLayer& layer = layers[k];
    for (Index i = 0; i < layer.in; ++i)
      for (Index o = 0; o < layer.out; ++o)
        gradient(layer.weights + i * layer.out + o) =
            (delta.col(o) * a[k].col(i)).sum();
    gradient.segment(layer.biases, layer.out) =
        delta.colwise().sum().transpose();
    if (k > 0) delta = propagate_back(layer, weights_, delta, a[k]);
  }
  return a.back().col(0);
}

nlohmann::ordered_json BpNetwork::parameters() const {
  return {{"layer_sizes", layer_sizes_}, {"weights", numbers_json(weights_)}};
}

BpNetwork BpNetwork::read(const JsonNode& node, std::size_t inputs) {
  std::vector<int> sizes;
  for (const JsonNode& size : node.at("layer_sizes").elements())
    sizes.push_back(static_cast<int>(size.integer(1, 1000)));
  if (sizes.size() < 2 || sizes.size() > 10 || sizes.back() != 1 ||
      sizes.front() != static_cast<int>(inputs))
    node.at("layer_sizes")
        .fail(fmt::format("must start with the {} inputs and end with 1 output",
                          inputs));
  BpNetwork network(sizes);
  const JsonNode weights = node.at("weights");
  try {
    network.set_weights(read_array(weights).matrix());
  } catch (const std::invalid_argument& error) {
    weights.fail(error.what());
  }
  return network;
}

void BpNetwork::put_arrays(FirmwareArrays& arrays) const {
  int number = 0;
  for (const NetworkLayer& layer : layers_of(layer_sizes_)) {
    ++number;
    const auto W = weights_.segment(layer.weights, layer.in * layer.out)
                       .reshaped(layer.out, layer.in);
    arrays.add({fmt::format("weights_{}", number),
                "of each neuron after one another",
                singles(W.reshaped<Eigen::RowMajor>())});
    arrays.add({fmt::format("biases_{}", number), "of the neurons",
                singles(weights_.segment(layer.biases, layer.out))});
  }
}

float BpNetwork::firmware_value(const FirmwareArrays& arrays,
                                std::span<const float> x) const {
  std::vector<float> a(x.begin(), x.end());
  for (std::size_t k = 1; k < layer_sizes_.size(); ++k) {
    const std::vector<float>& w = arrays.values(fmt::format("weights_{}", k));
    std::vector<float> z = arrays.values(fmt::format("biases_{}", k));
    for (std::size_t o = 0; o < z.size(); ++o) {
      for (std::size_t i = 0; i < a.size(); ++i)
        z[o] = z[o] + w[o * a.size() + i] * a[i];
      if (k + 1 < layer_sizes_.size()) z[o] = runtime::tanh_of(z[o]);
    }
    a = std::move(z);
  }
  return a[0];
}

FirmwareCode BpNetwork::firmware_code(std::size_t) const {
  FirmwareCode code{{}, network_lines(layer_sizes_)};
  if (layer_sizes_.size() > 2) code.sections.push_back("tanh");
  return code;
}

}  // namespace beamgyro::internal
