// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sensitivity/indices/pick_freeze.h"
#include "sensitivity/indices/rank_index.h"
#include "sensitivity/study/device_sample.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {

/// A share of devices with its interval after Clopper and Pearson.
struct DeviceShare {
  double value = 0;
  Interval interval{};
};

struct FactorResult {
  std::string key;
  IndexEstimate first, total;
  RankIndex first_by_rank;
  double total_by_product = 0;
  std::size_t rows = 0;
};

struct HalvedYield {
  std::string key;
  std::optional<DeviceShare> share;  // none for a choice, which has no half
};

struct PairYield {
  std::string first, second;  // keys
  DeviceShare share;          // with both halved
};

/// How narrow one tolerance has to be, as a share of its width, so that a share
/// of the devices is good while all others stay as they are.
struct NeededWidth {
  std::string key;
  std::optional<double> width;  // none: not even at kNarrowest
  // Of the widths at which the ends of the intervals of the yield are what is
  // wanted: the narrower one is certain to do.
  std::optional<double> narrow, wide;
};

constexpr double kNarrowest = 0.125;

/// Shares of devices whose figure has a magnitude of at most `limit`. Devices
/// that do not work do not meet it.
struct YieldResult {
  double limit = 0;
  DeviceShare as_is;
  std::vector<HalvedYield> halved;    // the largest share first
  std::vector<PairYield> pairs = {};  // likewise, of those that help most
  std::optional<double> target = {};
  std::vector<NeededWidth> needed = {};  // of those that help most
};

/// Returns the share of devices whose figure has a magnitude of at most
/// `limit`.
DeviceShare share_within(const std::vector<double>& values, double limit);

struct MeritResult {
  Merit merit{};
  bool of_logarithm = false;
  std::size_t rows = 0, samples = 0;  // with values in A and B, and all
  double variance = 0;                // of what is studied
  double sum_of_first = 0;
  std::array<double, 3> quantiles{};  // 5, 50, 95 % of the figure itself
  std::vector<FactorResult> factors;  // the largest total index first
  std::optional<YieldResult> yield;
};

struct MeritQuestion {
  Merit merit{};
  bool of_logarithm = false;
  std::optional<double> limit = {};
};

/// Estimates indices and yield of figure `index` of a sample. Of a logarithm,
/// a value that is not above 0 counts as none. Throws std::runtime_error when
/// no row has values in A and B.
MeritResult analysed(const DeviceSample& sample, std::size_t index,
                     const MeritQuestion& question, std::uint64_t seed);

}  // namespace beamgyro::internal
