// SPDX-License-Identifier: MIT
#include "compensation/scoring/noise_type.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace beamgyro::internal {
namespace {

constexpr double kLeastAverages = 30.0;
constexpr double kManyAverages = 100.0;
constexpr double kStationary = 0.25;  // below: no difference is needed
constexpr int kMostDifferences = 2;

using Averages = std::vector<std::vector<double>>;

double count_of(const Averages& averages) {
  double count = 0.0;
  for (const auto& stretch : averages)
    count += static_cast<double>(std::ranges::count_if(
        stretch, [](double v) { return !std::isnan(v); }));
  return count;
}

/// Takes the mean off each stretch; another turn-on is another mean.
void centre(Averages& averages) {
  for (auto& stretch : averages) {
    double sum = 0.0, count = 0.0;
    for (const double value : stretch)
      if (!std::isnan(value)) {
        sum += value;
        count += 1.0;
      }
    for (double& value : stretch) value -= sum / count;
  }
}

void difference(Averages& averages) {
  for (auto& stretch : averages) {
    if (stretch.empty()) continue;
    for (std::size_t k = 0; k + 1 < stretch.size(); ++k)
      stretch[k] = stretch[k + 1] - stretch[k];
    stretch.pop_back();
  }
}

/// Returns nothing for fewer than `least` averages, or without variance.
std::optional<double> lag_one(const Averages& averages, double least) {
  double squares = 0.0, count = 0.0, products = 0.0, pairs = 0.0;
  for (const auto& stretch : averages)
    for (std::size_t k = 0; k < stretch.size(); ++k) {
      if (std::isnan(stretch[k])) continue;
      squares += stretch[k] * stretch[k];
      count += 1.0;
      if (k + 1 == stretch.size() || std::isnan(stretch[k + 1])) continue;
      products += stretch[k] * stretch[k + 1];
      pairs += 1.0;
    }
  if (count < least || pairs < least / 2.0 || !(squares > 0.0))
    return std::nullopt;
  // Without a gap this is the sum of products over that of squares.
  const double edges = static_cast<double>(averages.size());
  return products / squares * std::max((count - edges) / pairs, 1.0);
}

}  // namespace

std::string_view name_of(NoiseType type) {
  constexpr std::string_view kNames[] = {
      "random run", "flicker walk",  "random walk", "flicker",
      "white",      "angle flicker", "quantisation"};  // from f^-4 on
  return kNames[static_cast<int>(type) + 4];
}

NoiseType noise_type(std::vector<std::vector<double>> averages,
                     NoiseType shorter) {
  const bool are_many = count_of(averages) >= kManyAverages;
  for (int differences = 0;; ++differences) {
    centre(averages);
    const std::optional<double> r =
        lag_one(averages, kLeastAverages - differences);
    if (!r) return shorter;
    const double delta = *r / (1.0 + *r);
    if (delta < kStationary || differences == kMostDifferences) {
      const double exponent = std::round(-2.0 * (delta + differences));
      const auto type = static_cast<NoiseType>(std::clamp(exponent, -4.0, 2.0));
      return are_many ? type : std::min(type, shorter);
    }
    difference(averages);
  }
}

}  // namespace beamgyro::internal
