// SPDX-License-Identifier: MIT
#include "compensation/export/export_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace beamgyro {
namespace {

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

}  // namespace

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

}  // namespace beamgyro
