// SPDX-License-Identifier: MIT
#include "random/random_stream.h"

#include <Random123/philox.h>
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

// Numerator over denominator of AS 241's three rational functions, highest
// power first: centre (variable 0.425^2 - q^2), middle and far tail (variable
// sqrt(-ln p) less 1.6 and 5).
using Coefficients = std::array<double, 8>;
struct Rational {
  Coefficients numerator, denominator;
};

constexpr Rational kCentre = {
    {2509.0809287301226727, 33430.575583588128105, 67265.770927008700853,
     45921.953931549871457, 13731.693765509461125, 1971.5909503065514427,
     133.14166789178437745, 3.3871328727963666080},
    {5226.4952788528545610, 28729.085735721942674, 39307.895800092710610,
     21213.794301586595867, 5394.1960214247511077, 687.18700749205790830,
     42.313330701600911252, 1.0}};
constexpr Rational kMiddle = {
    {7.74545014278341407640e-4, 2.27238449892691845833e-2,
     2.41780725177450611770e-1, 1.27045825245236838258, 3.64784832476320460504,
     5.76949722146069140550, 4.63033784615654529590, 1.42343711074968357734},
    {1.05075007164441684324e-9, 5.47593808499534494600e-4,
     1.51986665636164571966e-2, 1.48103976427480074590e-1,
     6.89767334985100004550e-1, 1.67638483018380384940, 2.05319162663775882187,
     1.0}};
constexpr Rational kFar = {
    {2.01033439929228813265e-7, 2.71155556874348757815e-5,
     1.24266094738807843860e-3, 2.65321895265761230930e-2,
     2.96560571828504891230e-1, 1.78482653991729133580, 5.46378491116411436990,
     6.65790464350110377720},
    {2.04426310338993978564e-15, 1.42151175831644588870e-7,
     1.84631831751005468180e-5, 7.86869131145613259100e-4,
     1.48753612908506148525e-2, 1.36929880922735805310e-1,
     5.99832206555887937690e-1, 1.0}};
constexpr double kCentreHalfWidth = 0.425;

inline double polynomial(const Coefficients& c, double x) {
  return ((((((c[0] * x + c[1]) * x + c[2]) * x + c[3]) * x + c[4]) * x +
           c[5]) *
              x +
          c[6]) *
             x +
         c[7];
}

inline double ratio(const Rational& f, double x) {
  return polynomial(f.numerator, x) / polynomial(f.denominator, x);
}

// The upper 52 bits as an odd multiple of 2^-53, less `origin` in [0, 1]: both
// sums are exact.
inline double number(std::uint64_t word, double origin) {
  constexpr std::uint64_t kOne = std::bit_cast<std::uint64_t>(1.0);
  return (std::bit_cast<double>(kOne | (word >> 12)) - (1.0 + origin)) +
         0x1p-53;
}

// Quantile of probability 1/2 + q, |q| <= kCentreHalfWidth.
inline double central_quantile(double q) {
  const double r = kCentreHalfWidth * kCentreHalfWidth - q * q;
  return q * ratio(kCentre, r);
}

// The same beyond it; `tail` = 1/2 - |q|.
double tail_quantile(double q, double tail) {
  const double r = std::sqrt(-std::log(tail));
  const double magnitude =
      r <= 5.0 ? ratio(kMiddle, r - 1.6) : ratio(kFar, r - 5.0);
  return std::copysign(magnitude, q);
}

double quantile(double q) {
  const double side = std::abs(q);
  return side > kCentreHalfWidth ? tail_quantile(q, 0.5 - side)
                                 : central_quantile(q);
}

constexpr std::uint64_t kBlocks = std::uint64_t{1} << 32;

[[noreturn]] void throw_used_up() {
  throw std::runtime_error("random stream used up after 2^33 numbers");
}

constexpr std::size_t kBatch = 256;

// Quantiles of one batch: the centre without branches, then the tails (15 %).
void batch_quantiles(const std::array<double, kBatch>& q, double* values) {
  std::array<std::uint32_t, kBatch> tail;
  std::size_t tails = 0;
  std::array<double, kBatch> z;  // a local one, so that the loop vectorises
  for (std::size_t i = 0; i < kBatch; ++i) z[i] = central_quantile(q[i]);
  for (std::size_t i = 0; i < kBatch; ++i) {
    tail[tails] = static_cast<std::uint32_t>(i);
    tails += std::abs(q[i]) > kCentreHalfWidth ? 1 : 0;
  }
  for (std::size_t j = 0; j < tails; ++j) z[tail[j]] = quantile(q[tail[j]]);
  std::copy(z.begin(), z.end(), values);
}

// Philox4x32-10 of kBatch / 2 consecutive blocks, as next_block() has them one
// by one: each operation over all blocks before the next, so that it
// vectorises.
std::array<std::uint64_t, kBatch> philox_batch(
    std::uint32_t first, const std::array<std::uint32_t, 3>& stream,
    std::array<std::uint32_t, 2> key) {
  constexpr std::size_t kLanes = 32;
  std::array<std::uint64_t, kBatch> words;
  for (std::size_t block = 0; block < kBatch / 2; block += kLanes) {
    std::array<std::uint32_t, kLanes> a, b, c, d;
    for (std::size_t i = 0; i < kLanes; ++i) {
      a[i] = first + static_cast<std::uint32_t>(block + i);
      b[i] = stream[0];
      c[i] = stream[1];
      d[i] = stream[2];
    }
    std::array<std::uint32_t, 2> round_key = key;
    for (int round = 0; round < 10; ++round) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        const std::uint64_t p = std::uint64_t{PHILOX_M4x32_0} * a[i];
        const std::uint64_t q = std::uint64_t{PHILOX_M4x32_1} * c[i];
        a[i] = static_cast<std::uint32_t>(q >> 32) ^ b[i] ^ round_key[0];
        c[i] = static_cast<std::uint32_t>(p >> 32) ^ d[i] ^ round_key[1];
        b[i] = static_cast<std::uint32_t>(q);
        d[i] = static_cast<std::uint32_t>(p);
      }
      round_key[0] += PHILOX_W32_0;
      round_key[1] += PHILOX_W32_1;
    }
    for (std::size_t i = 0; i < kLanes; ++i) {
      words[2 * (block + i)] = (std::uint64_t{b[i]} << 32) | a[i];
      words[2 * (block + i) + 1] = (std::uint64_t{d[i]} << 32) | c[i];
    }
  }
  return words;
}

}  // namespace

double normal_quantile(double probability) {
  if (!(probability > 0.0 && probability < 1.0))
    throw std::invalid_argument(
        fmt::format("probability is {}, must be between 0 and 1", probability));
  const double q = probability - 0.5;
  return q < -kCentreHalfWidth ? tail_quantile(q, probability) : quantile(q);
}

double uniform_number(std::uint64_t word) { return number(word, 0.0); }

RandomStream::RandomStream(std::uint64_t seed, std::uint32_t device,
                           std::uint32_t run, RandomPurpose purpose)
    : key_{static_cast<std::uint32_t>(seed),
           static_cast<std::uint32_t>(seed >> 32)},
      stream_{static_cast<std::uint32_t>(purpose), device, run} {}

inline std::array<std::uint64_t, 2> RandomStream::next_block() {
  if (next_block_ == kBlocks) throw_used_up();
  const philox4x32_key_t key = {{key_[0], key_[1]}};
  const philox4x32_ctr_t counter = {{static_cast<std::uint32_t>(next_block_++),
                                     stream_[0], stream_[1], stream_[2]}};
  const philox4x32_ctr_t r = philox4x32_R(10, counter, key);
  return {(std::uint64_t{r.v[1]} << 32) | r.v[0],
          (std::uint64_t{r.v[3]} << 32) | r.v[2]};
}

std::uint64_t RandomStream::next_word() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_word_;
  }
  const auto words = next_block();
  spare_word_ = words[1];
  has_spare_ = true;
  return words[0];
}

std::uint64_t RandomStream::position() const {
  return 2 * next_block_ - (has_spare_ ? 1 : 0);
}

void RandomStream::seek(std::uint64_t position) {
  if (position > 2 * kBlocks) throw_used_up();
  next_block_ = position / 2;
  has_spare_ = false;
  if (position % 2 == 1) next_word();
}

double RandomStream::uniform() { return number(next_word(), 0.0); }

double RandomStream::normal() { return quantile(number(next_word(), 0.5)); }

void RandomStream::fill_normal(std::span<double> values) {
  std::size_t i = 0;
  if (has_spare_ && !values.empty()) values[i++] = normal();
  std::array<double, kBatch> q;
  for (; values.size() - i >= kBatch; i += kBatch) {
    if (next_block_ + kBatch / 2 > kBlocks) throw_used_up();
    const auto words =
        philox_batch(static_cast<std::uint32_t>(next_block_), stream_, key_);
    next_block_ += kBatch / 2;
    for (std::size_t j = 0; j < kBatch; ++j) q[j] = number(words[j], 0.5);
    batch_quantiles(q, &values[i]);
  }
  for (; i < values.size(); ++i) values[i] = normal();
}

}  // namespace beamgyro::internal
