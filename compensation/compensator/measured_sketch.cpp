// SPDX-License-Identifier: MIT
#include "compensation/compensator/measured_sketch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <iterator>
#include <set>

#include "compensation/inputs/sample_ranges.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kStretch = 32;  // samples
constexpr std::size_t kLeastChanges = kStretch / 2;
constexpr std::ptrdiff_t kLeastFound = kSketch / 4;

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

std::uint64_t bits_of(double value) {
  return std::bit_cast<std::uint64_t>(value + 0.0);  // one zero
}

constexpr std::uint64_t kBase = 0x2545f4914f6cdd1dU;
constexpr std::uint64_t kInverse =
    0x59071d96d81ecd35U;  // kBase kInverse = 1 mod 2^64
static_assert(kBase * kInverse == 1);

constexpr std::uint64_t power_of_base(std::size_t exponent) {
  return exponent == 0 ? 1 : kBase * power_of_base(exponent - 1);
}

/// Sums of s_i B^(n - 1 - i) and of s_i B^i over the last n = kStretch samples,
/// modulo 2^64, which one sample more changes in a few operations.
class Stretches {
 public:
  void add(std::uint64_t sample) {
    std::uint64_t& oldest = last_[count_ % kStretch];
    forward_ = forward_ * kBase - oldest * power_of_base(kStretch) + sample;
    backward_ =
        (backward_ - oldest) * kInverse + sample * power_of_base(kStretch - 1);
    oldest = sample;
    ++count_;
  }
  bool full() const { return count_ >= kStretch; }
  std::uint64_t hash() const {
    return std::min(mixed(forward_), mixed(backward_));
  }

 private:
  std::array<std::uint64_t, kStretch> last_{};
  std::size_t count_ = 0;
  std::uint64_t forward_ = 0, backward_ = 0;
};

/// Calls `take` with the hash of each stretch whose rate changes enough.
template <class Take>
void for_each_stretch(const Recording& recording, const Take& take) {
  const auto& rate = column_values(recording, "rate");
  const auto& temperature = column_values(recording, "temperature");
  for (const SampleRange& range : powered_stretches(recording)) {
    Stretches stretches;
    std::size_t same = 0;  // samples with the rate of the one before
    for (std::size_t k = range.begin; k < range.end; ++k) {
      stretches.add(mixed(mixed(bits_of(rate[k])) ^ bits_of(temperature[k])));
      if (k > range.begin && rate[k] == rate[k - 1]) ++same;
      if (!stretches.full()) continue;
      const std::size_t first = k + 1 - kStretch;
      if (first > range.begin && rate[first] == rate[first - 1]) --same;
      if (kStretch - 1 - same >= kLeastChanges) take(stretches.hash());
    }
  }
}

}  // namespace

MeasuredSketch measured_sketch(const Recording& recording, std::size_t most) {
  std::set<std::uint64_t> least;
  for_each_stretch(recording, [&least, most](std::uint64_t hash) {
    if (least.size() == most && hash >= *least.rbegin()) return;
    least.insert(hash);
    if (least.size() > most) least.erase(std::prev(least.end()));
  });
  if (least.size() < kSketch) return {};
  return {least.begin(), least.end()};
}

std::vector<std::uint64_t> stretches_up_to(std::uint64_t limit,
                                           const Recording& recording) {
  std::vector<std::uint64_t> hashes;
  for_each_stretch(recording, [&](std::uint64_t hash) {
    if (hash <= limit) hashes.push_back(hash);
  });
  std::ranges::sort(hashes);
  hashes.erase(std::unique(hashes.begin(), hashes.end()), hashes.end());
  return hashes;
}

bool shares_stretches(const MeasuredSketch& sketch,
                      const std::vector<std::uint64_t>& stretches) {
  if (sketch.empty()) return false;
  const auto end = std::ranges::upper_bound(stretches, sketch.back());
  const auto found = end - stretches.begin();
  const auto shared =
      std::count_if(stretches.begin(), end, [&](std::uint64_t hash) {
        return std::ranges::binary_search(sketch, hash);
      });
  return found >= kLeastFound && 2 * shared >= found;
}

}  // namespace beamgyro::internal
