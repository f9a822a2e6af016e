// SPDX-License-Identifier: MIT
// The network as parameters of a file and as exported code.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "compensation/firmware/runtime.h"
#include "compensation/models/bp_network.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {
namespace {

// Layers of a network as rows: weights of a neuron after one another.
struct LayerArrays {
  std::vector<float> weights, biases;
};

std::vector<LayerArrays> layer_arrays(const BpNetwork& network) {
  const std::vector<int>& sizes = network.layer_sizes();
  const std::vector<float> flat = singles(network.weights());
  std::vector<LayerArrays> result;
  std::size_t offset = 0;
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const auto in = static_cast<std::size_t>(sizes[k - 1]);
    const auto out = static_cast<std::size_t>(sizes[k]);
    LayerArrays& layer = result.emplace_back();
    for (std::size_t o = 0; o < out; ++o)
      for (std::size_t i = 0; i < in; ++i)
        layer.weights.push_back(flat[offset + i * out + o]);
    for (std::size_t o = 0; o < out; ++o)
      layer.biases.push_back(flat[offset + in * out + o]);
    offset += (in + 1) * out;
  }
  return result;
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
  for (const LayerArrays& layer : layer_arrays(*this)) {
    ++number;
    arrays.add({fmt::format("weights_{}", number),
                "of each neuron after one another", layer.weights});
    arrays.add(
        {fmt::format("biases_{}", number), "of the neurons", layer.biases});
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
