// SPDX-License-Identifier: MIT
#include "compensation/scoring/scale_factor.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/models/array_view.h"
#include "compensation/scoring/rate_departure.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint8_t kLeftOut = kUnpowered | kOutputSaturated;

/// Samples of one plateau, one row each.
struct Plateau {
  std::vector<double> time;         // [s]
  std::vector<double> temperature;  // [degC]
  std::vector<double> truth;        // [deg/s]
  std::vector<double> raw;          // [deg/s]
  std::vector<double> compensated;  // [deg/s]
};

Eigen::VectorXd centred(const std::vector<double>& values) {
  return array_view(values) - array_view(values).mean();
}

SlopeSums sums_of(const Plateau& plateau) {
  SlopeSums none;
  none.samples = plateau.time.size();
  if (plateau.time.empty()) {
    return none;
  }
  const Eigen::VectorXd truth = centred(plateau.truth);
  if (truth.isZero(0.0)) {
    return none;
  }
  const Eigen::VectorXd temperature = centred(plateau.temperature);
  const Eigen::VectorXd v = without_drift(truth, temperature, plateau.time);
  return {.compensated = v.dot(centred(plateau.compensated)),
          .raw = v.dot(centred(plateau.raw)),
          .truth = v.dot(truth),
          .largest_departure =
              without_temperature(truth, temperature).cwiseAbs().maxCoeff(),
          .samples = plateau.time.size()};
}

/// The usable samples of every plateau, without those within kSettlingTime
/// after a larger rate or a larger step of it. `compensated` may be empty.
std::vector<Plateau> plateaus_of(const Recording& recording,
                                 std::span<const double> compensated,
                                 double largest_rate, double largest_step) {
  const auto& time = recording.time;
  const auto& truth = column_values(recording, "true_rate");
  const auto& raw = column_values(recording, "rate");
  const Column* temperature = find_column(recording, "temperature");
  const double settling = kSettlingTime - 0.5 * usual_step(recording);
  std::vector<Plateau> plateaus;
  double last_large = -std::numeric_limits<double>::infinity();  // [s]
  for (const SampleRange& range : temperature_plateaus(recording)) {
    Plateau& plateau = plateaus.emplace_back();
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (k > 0 && std::abs(truth[k] - truth[k - 1]) > largest_step) {
        last_large = time[k];
      }
      if (std::abs(truth[k]) > largest_rate) {
        last_large = time[k];
        continue;
      }
      if (time[k] - last_large >= settling &&
          (recording.status[k] & kLeftOut) == 0) {
        plateau.time.push_back(time[k]);
        plateau.temperature.push_back(temperature ? temperature->values[k]
                                                  : 0.0);
        plateau.truth.push_back(truth[k]);
        plateau.raw.push_back(raw[k]);
        plateau.compensated.push_back(compensated.empty() ? raw[k]
                                                          : compensated[k]);
      }
    }
  }
  return plateaus;
}

}  // namespace

SlopeSums& SlopeSums::operator+=(const SlopeSums& other) {
  compensated += other.compensated;
  raw += other.raw;
  truth += other.truth;
  largest_departure = std::max(largest_departure, other.largest_departure);
  samples += other.samples;
  return *this;
}

SlopeSums slope_sums(const Recording& recording,
                     std::span<const double> compensated, double largest_rate) {
  if (compensated.size() != recording.time.size()) {
    throw std::invalid_argument(fmt::format(
        "compensated rate: {} values for {} times, must be one each",
        compensated.size(), recording.time.size()));
  }
  SlopeSums sums;
  for (const Plateau& plateau :
       plateaus_of(recording, compensated, largest_rate, kEveryRate)) {
    sums += sums_of(plateau);
  }
  return sums;
}

std::vector<PlateauSlope> plateau_slopes(const Recording& recording,
                                         double least_departure,
                                         std::span<const double> compensated) {
  std::vector<PlateauSlope> slopes;
  // A rate that is never held has no settled samples.
  for (const double largest_step : {least_departure, kEveryRate}) {
    for (const Plateau& plateau :
         plateaus_of(recording, compensated, kEveryRate, largest_step)) {
      const SlopeSums sums = sums_of(plateau);
      if (sums.largest_departure >= least_departure) {
        slopes.push_back({array_view(plateau.temperature).mean(), sums.raw,
                          sums.truth, sums.compensated});
      }
    }
    if (!slopes.empty()) {
      break;
    }
  }
  return slopes;
}

std::optional<double> share_retained(const SlopeSums& sums) {
  if (sums.largest_departure < kLeastRateDeparture) return std::nullopt;
  return sums.compensated / sums.raw;
}

}  // namespace beamgyro::internal
