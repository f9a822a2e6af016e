// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <utility>

#include "compensation/network/batch_network.h"

// Wider registers where the processor has them. The lanes are in the source,
// no product is fused with a sum, so every version gives the same bits. The
// choice is made before the thread sanitizer has started, which it must not be.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__)
#define BEAMGYRO_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define BEAMGYRO_WIDE
#endif
#define BEAMGYRO_INLINE inline __attribute__((always_inline))

namespace beamgyro::internal {
namespace {

using Eigen::Index;

using Lane = double __attribute__((vector_size(8 * kLanes), may_alias));
using Bits = std::int64_t __attribute__((vector_size(8 * kLanes)));

Index lanes_of(Index samples) { return (samples + kLanes - 1) / kLanes; }

BEAMGYRO_INLINE const Lane* row_of(const double* rows, Index k) {
  return reinterpret_cast<const Lane*>(rows + k * kBatchSamples);
}

BEAMGYRO_INLINE Lane* row_of(double* rows, Index k) {
  return reinterpret_cast<Lane*>(rows + k * kBatchSamples);
}

// tanh z = (e^u - 1) / (e^u + 1), u = 2 z = n ln 2 + r. With Pade's [6/6] of
// e^r = (Q + r P) / (Q - r P), wrong by 2e-19 for |r| < ln 2 / 2,
//
//   e^u - 1 = (2^n 2 r P + (2^n - 1) (Q - r P)) / (Q - r P),
//
// in which nothing cancels at small z. ln 2 in two parts, so that n ln 2 is
// exact; from |u| = 40 on tanh is 1 to the last bit.
BEAMGYRO_INLINE void tanh_lanes(Lane* z, Index count) {
  constexpr double kLimit = 40.0, kShift = 6755399441055744.0;  // 1.5 2^52
  constexpr double kLn2 = 0x1.62e42fefa3800p-1, kRest = 0x1.ef35793c76730p-45;
  constexpr double kPerLn2 = 1.4426950408889634;
  for (Index k = 0; k < count; ++k) {
    Lane u = z[k] + z[k];
    u = u > kLimit ? Lane{} + kLimit : u;
    u = u < -kLimit ? Lane{} - kLimit : u;
    const Lane shifted = u * kPerLn2 + kShift;
    const Lane n = shifted - kShift;
    const Lane power = reinterpret_cast<Lane>(
        (reinterpret_cast<Bits>(shifted) + std::int64_t{1023}) << 52);
    const Lane r = (u - n * kLn2) - n * kRest;
    const Lane s = r * r;
    const Lane odd = r * (332640.0 + s * (10080.0 + s * 42.0));
    const Lane low = (665280.0 + s * (75600.0 + s * (840.0 + s))) - odd;
    const Lane above = power * (odd + odd) + (power - 1.0) * low;
    z[k] = above / (above + (low + low));
  }
}

BEAMGYRO_INLINE void forward_layer(const NetworkLayer& layer, const double* w,
                                   const double* a, double* out, Index count) {
  for (Index o = 0; o < layer.out; ++o) {
    Lane* z = row_of(out, o);
    const double bias = w[layer.biases + o];
    for (Index k = 0; k < count; ++k) z[k] = Lane{} + bias;
    for (Index i = 0; i < layer.in; ++i) {
      const double slope = w[layer.weights + i * layer.out + o];
      const Lane* below = row_of(a, i);
      for (Index k = 0; k < count; ++k) z[k] += slope * below[k];
    }
    if (!layer.last) tanh_lanes(z, count);
  }
}

// Rows of J that belong to `layer`, `delta` being dy/dz of its neurons.
BEAMGYRO_INLINE void jacobian_of_layer(const NetworkLayer& layer,
                                       const double* a, const double* delta,
                                       double* jacobian, Index count) {
  for (Index o = 0; o < layer.out; ++o) {
    const Lane* slope = row_of(delta, o);
    Lane* bias = row_of(jacobian, layer.biases + o);
    for (Index k = 0; k < count; ++k) bias[k] = slope[k];
    for (Index i = 0; i < layer.in; ++i) {
      const Lane* below = row_of(a, i);
      Lane* row = row_of(jacobian, layer.weights + i * layer.out + o);
      for (Index k = 0; k < count; ++k) row[k] = slope[k] * below[k];
    }
  }
}

BEAMGYRO_INLINE void propagate_batch_back(const NetworkLayer& layer,
                                          const double* w, const double* a,
                                          const double* delta, double* below,
                                          Index count) {
  for (Index i = 0; i < layer.in; ++i) {
    Lane* sum = row_of(below, i);
    for (Index k = 0; k < count; ++k) sum[k] = Lane{};
    for (Index o = 0; o < layer.out; ++o) {
      const double slope = w[layer.weights + i * layer.out + o];
      const Lane* of = row_of(delta, o);
      for (Index k = 0; k < count; ++k) sum[k] += slope * of[k];
    }
    const Lane* tanh = row_of(a, i);
    for (Index k = 0; k < count; ++k) sum[k] *= 1.0 - tanh[k] * tanh[k];
  }
}

// Sums over the samples of the products of delta with the rows of J.
BEAMGYRO_INLINE void gradient_of_layer(const NetworkLayer& layer,
                                       const double* a, const double* delta,
                                       double* gradient, Index count) {
  for (Index o = 0; o < layer.out; ++o) {
    const Lane* slope = row_of(delta, o);
    Lane s{};
    for (Index k = 0; k < count; ++k) s += slope[k];
    gradient[layer.biases + o] += (s[0] + s[1]) + (s[2] + s[3]);
    for (Index i = 0; i < layer.in; ++i) {
      const Lane* below = row_of(a, i);
      s = Lane{};
      for (Index k = 0; k < count; ++k) s += slope[k] * below[k];
      gradient[layer.weights + i * layer.out + o] +=
          (s[0] + s[1]) + (s[2] + s[3]);
    }
  }
}

// First and second derivative along v of the outputs of a layer, from those
// of the layer below; the inputs have none.
BEAMGYRO_INLINE void derivatives_of_layer(const NetworkLayer& layer,
                                          const double* w, const double* v,
                                          const double* a, const double* below,
                                          double* out, const double* outputs,
                                          Index widest, Index count) {
  for (Index o = 0; o < layer.out; ++o) {
    Lane* first = row_of(out, o);
    Lane* second = row_of(out, widest + o);
    const double bias = v[layer.biases + o];
    for (Index k = 0; k < count; ++k) {
      first[k] = Lane{} + bias;
      second[k] = Lane{};
    }
    for (Index i = 0; i < layer.in; ++i) {
      const Index place = layer.weights + i * layer.out + o;
      const double slope = v[place], slope2 = 2.0 * v[place], W = w[place];
      const Lane* value = row_of(a, i);
      for (Index k = 0; k < count; ++k) first[k] += slope * value[k];
      if (layer.weights == 0) continue;
      const Lane* first_below = row_of(below, i);
      const Lane* second_below = row_of(below, widest + i);
      for (Index k = 0; k < count; ++k) {
        first[k] += W * first_below[k];
        second[k] += slope2 * first_below[k] + W * second_below[k];
      }
    }
    if (layer.last) continue;
    const Lane* tanh = row_of(outputs, o);
    for (Index k = 0; k < count; ++k) {
      const Lane slope = 1.0 - tanh[k] * tanh[k];
      second[k] = slope * (second[k] - 2.0 * tanh[k] * first[k] * first[k]);
      first[k] *= slope;
    }
  }
}

// Neurons of the widest layer above the inputs.
Index widest_of(const std::vector<NetworkLayer>& layers) {
  Index widest = 1;
  for (const NetworkLayer& layer : layers)
    widest = layer.out > widest ? layer.out : widest;
  return widest;
}

// Rows of activations before those that the last layer takes.
Index rows_below_last(const std::vector<NetworkLayer>& layers) {
  Index rows = 0;
  for (const NetworkLayer& layer : layers) rows += layer.in;
  return rows - layers.back().in;
}

// Calls `kOfLayer` for each layer, the last first, with dy/dz of its neurons
// times `e` of the samples.
template <auto kOfLayer>
BEAMGYRO_INLINE void go_back(const std::vector<NetworkLayer>& layers,
                             const double* w, const SampleBlock& block,
                             const double* e, double* delta, double* result) {
  const Index count = lanes_of(block.samples);
  double* next = delta + widest_of(layers) * kBatchSamples;
  const double* a = block.activations + rows_below_last(layers) * kBatchSamples;
  std::copy_n(e, count * kLanes, delta);
  for (std::size_t n = layers.size(); n-- > 0;) {
    const NetworkLayer& layer = layers[n];
    kOfLayer(layer, a, delta, result, count);
    if (n == 0) break;
    propagate_batch_back(layer, w, a, delta, next, count);
    std::swap(delta, next);
    a -= layers[n - 1].in * kBatchSamples;
  }
}

// Products of four rows with two: eight sums stay in registers.
BEAMGYRO_INLINE void add_tile(const double* left, const double* right,
                              Index count, double* products, Index stride) {
  const Lane* a0 = row_of(left, 0);
  const Lane* a1 = row_of(left, 1);
  const Lane* a2 = row_of(left, 2);
  const Lane* a3 = row_of(left, 3);
  const Lane* b0 = row_of(right, 0);
  const Lane* b1 = row_of(right, 1);
  Lane s00{}, s01{}, s10{}, s11{}, s20{}, s21{}, s30{}, s31{};
  for (Index k = 0; k < count; ++k) {
    const Lane y0 = b0[k], y1 = b1[k];
    s00 += a0[k] * y0;
    s01 += a0[k] * y1;
    s10 += a1[k] * y0;
    s11 += a1[k] * y1;
    s20 += a2[k] * y0;
    s21 += a2[k] * y1;
    s30 += a3[k] * y0;
    s31 += a3[k] * y1;
  }
  const Lane* sums[kTile][2] = {
      {&s00, &s01}, {&s10, &s11}, {&s20, &s21}, {&s30, &s31}};
  for (Index i = 0; i < kTile; ++i)
    for (Index j = 0; j < 2; ++j) {
      const Lane& s = *sums[i][j];
      products[i * stride + j] += (s[0] + s[1]) + (s[2] + s[3]);
    }
}

}  // namespace

BEAMGYRO_WIDE void forward(const std::vector<NetworkLayer>& layers,
                           const double* w, const SampleBlock& block) {
  const Index count = lanes_of(block.samples);
  double* a = block.activations;
  for (const NetworkLayer& layer : layers) {
    double* out = layer.last ? block.error : a + layer.in * kBatchSamples;
    forward_layer(layer, w, a, out, count);
    a = out;
  }
  Lane* error = row_of(block.error, 0);
  const Lane* target = row_of(block.target, 0);
  const Lane* weight = row_of(block.weight, 0);
  for (Index k = 0; k < count; ++k)
    error[k] = weight[k] * (error[k] - target[k]);
}

BEAMGYRO_WIDE void jacobian(const std::vector<NetworkLayer>& layers,
                            const double* w, const SampleBlock& block,
                            double* delta, double* jacobian) {
  go_back<jacobian_of_layer>(layers, w, block, block.weight, delta, jacobian);
}

BEAMGYRO_WIDE void add_gradient(const std::vector<NetworkLayer>& layers,
                                const double* w, const SampleBlock& block,
                                const double* e, double* delta,
                                double* gradient) {
  go_back<gradient_of_layer>(layers, w, block, e, delta, gradient);
}

BEAMGYRO_WIDE void second_derivative(const std::vector<NetworkLayer>& layers,
                                     const double* w, const double* v,
                                     const SampleBlock& block, double* scratch,
                                     double* curvature) {
  const Index count = lanes_of(block.samples), widest = widest_of(layers);
  const double* a = block.activations;
  double* below = scratch + 2 * widest * kBatchSamples;
  double* out = scratch;
  for (const NetworkLayer& layer : layers) {
    const double* outputs = a + layer.in * kBatchSamples;
    derivatives_of_layer(layer, w, v, a, below, out, outputs, widest, count);
    a = outputs;
    std::swap(below, out);
  }
  const Lane* second = row_of(below, widest);
  const Lane* weight = row_of(block.weight, 0);
  Lane* result = row_of(curvature, 0);
  for (Index k = 0; k < count; ++k) result[k] = weight[k] * second[k];
}

BEAMGYRO_WIDE void add_products(const double* jacobian, Index rows,
                                Index samples, double* products) {
  const Index count = lanes_of(samples);
  for (Index i = 0; i < rows; i += kTile)
    for (Index j = 0; j < i + kTile; j += 2)
      add_tile(jacobian + i * kBatchSamples, jacobian + j * kBatchSamples,
               count, products + i * rows + j, rows);
}

BEAMGYRO_WIDE void tanh_in_place(double* z, Index entries) {
  tanh_lanes(reinterpret_cast<Lane*>(z), entries / kLanes);
}

}  // namespace beamgyro::internal
