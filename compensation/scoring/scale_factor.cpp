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
constexpr double kMostWeight = 100.0;  // [-], of a run by its power

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
  if (plateau.time.empty()) return none;
  const Eigen::VectorXd truth = centred(plateau.truth);
  if (truth.isZero(0.0)) return none;
  const Eigen::VectorXd temperature = centred(plateau.temperature);
  const Eigen::VectorXd v = without_drift(truth, temperature, plateau.time);
  return {.compensated = v.dot(centred(plateau.compensated)),
          .raw = v.dot(centred(plateau.raw)),
          .truth = v.dot(truth),
          .largest_departure =
              without_temperature(truth, temperature).cwiseAbs().maxCoeff(),
          .samples = plateau.time.size()};
}

/// Tells of each sample, in order, whether its rate has lasted.
class Settled {
 public:
  explicit Settled(const Recording& recording)
      : time_(recording.time),
        truth_(column_values(recording, "true_rate")),
        settling_(kSettlingTime - 0.5 * usual_step(recording)) {}

  /// Returns whether no rate above `largest_rate` and no step above
  /// `largest_step` came within kSettlingTime before sample k.
  bool after_steps(std::size_t k, double largest_rate, double largest_step) {
    const bool stepped =
        k > 0 && std::abs(truth_[k] - truth_[k - 1]) > largest_step;
    const bool large = std::abs(truth_[k]) > largest_rate;
    if (stepped || large) last_large_ = time_[k];
    return !large && time_[k] - last_large_ >= settling_;
  }

  /// Returns whether the rate of sample k was held for kSettlingTime.
  bool held(std::size_t k) {
    if (std::abs(truth_[k] - truth_[begin_]) > kHeldWithin) begin_ = k;
    return k > begin_ && time_[k] - time_[begin_] >= settling_;
  }

 private:
  const std::vector<double>&time_, &truth_;
  double settling_;                                               // [s]
  double last_large_ = -std::numeric_limits<double>::infinity();  // [s]
  std::size_t begin_ = 0;  // of the rate that is held
};

/// The usable samples of every plateau that `is_settled` takes.
/// `compensated` may be empty.
template <class Predicate>
std::vector<Plateau> plateaus_of(const Recording& recording,
                                 std::span<const double> compensated,
                                 const Predicate& is_settled) {
  const auto& truth = column_values(recording, "true_rate");
  const auto& raw = column_values(recording, "rate");
  const Column* temperature = find_column(recording, "temperature");
  std::vector<Plateau> plateaus;
  for (const SampleRange& range : temperature_plateaus(recording)) {
    Plateau& plateau = plateaus.emplace_back();
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (!is_settled(k) || (recording.status[k] & kLeftOut) != 0) continue;
      plateau.time.push_back(recording.time[k]);
      plateau.temperature.push_back(temperature ? temperature->values[k] : 0.0);
      plateau.truth.push_back(truth[k]);
      plateau.raw.push_back(raw[k]);
      plateau.compensated.push_back(compensated.empty() ? raw[k]
                                                        : compensated[k]);
    }
  }
  return plateaus;
}

std::vector<Plateau> plateaus_after_steps(const Recording& recording,
                                          std::span<const double> compensated,
                                          double largest_rate,
                                          double largest_step) {
  Settled settled(recording);
  return plateaus_of(recording, compensated, [&](std::size_t k) {
    return settled.after_steps(k, largest_rate, largest_step);
  });
}

PlateauSlope slope_of(const Plateau& plateau, const SlopeSums& sums) {
  return {array_view(plateau.temperature).mean(), sums.raw, sums.truth,
          sums.compensated};
}

/// Half of the 95 % interval of the slope of the raw rate: of what v, drift
/// and temperature leave of it, as if that were white.
double slope_uncertainty(const Plateau& plateau, const SlopeSums& sums) {
  const Eigen::VectorXd temperature = centred(plateau.temperature);
  const Eigen::VectorXd v =
      without_drift(centred(plateau.truth), temperature, plateau.time);
  const Eigen::VectorXd y =
      without_drift(centred(plateau.raw), temperature, plateau.time);
  const double square = v.squaredNorm();
  const double slope = sums.raw / sums.truth;
  const auto freedom = static_cast<double>(plateau.time.size()) - 4.0;
  return 1.96 * std::sqrt((y - slope * v).squaredNorm() / (freedom * square));
}

}  // namespace

SlopeSums& SlopeSums::operator+=(const SlopeSums& other) {
  compensated += other.compensated;
  raw += other.raw;
  truth += other.truth;
  power += other.power;
  largest_departure = std::max(largest_departure, other.largest_departure);
  samples += other.samples;
  return *this;
}

SlopeSums SlopeSums::by_power() const {
  if (!(truth > 0.0)) return *this;
  const double weight = std::min(power / truth, kMostWeight);
  SlopeSums weighed = *this;
  weighed.compensated *= weight;
  weighed.raw *= weight;
  weighed.truth *= weight;
  return weighed;
}

SlopeSums slope_sums(const Recording& recording,
                     std::span<const double> compensated, double largest_rate) {
  if (compensated.size() != recording.time.size())
    throw std::invalid_argument(fmt::format(
        "compensated rate: {} values for {} times, must be one each",
        compensated.size(), recording.time.size()));
  SlopeSums sums;
  std::vector<double> truth;
  for (const Plateau& plateau :
       plateaus_after_steps(recording, compensated, largest_rate, kEveryRate)) {
    sums += sums_of(plateau);
    truth.insert(truth.end(), plateau.truth.begin(), plateau.truth.end());
  }
  if (!truth.empty()) sums.power = centred(truth).squaredNorm();
  return sums;
}

std::vector<PlateauSlope> plateau_slopes(const Recording& recording,
                                         double least_departure,
                                         std::span<const double> compensated) {
  std::vector<PlateauSlope> slopes;
  // A rate that is never held has no settled samples.
  for (const double largest_step : {least_departure, kEveryRate}) {
    for (const Plateau& plateau : plateaus_after_steps(
             recording, compensated, kEveryRate, largest_step)) {
      const SlopeSums sums = sums_of(plateau);
      if (sums.largest_departure >= least_departure)
        slopes.push_back(slope_of(plateau, sums));
    }
    if (!slopes.empty()) break;
  }
  return slopes;
}

std::vector<HeldSlope> held_slopes(const Recording& recording,
                                   std::span<const double> compensated) {
  Settled settled(recording);
  std::vector<HeldSlope> slopes;
  for (const Plateau& plateau :
       plateaus_of(recording, compensated,
                   [&](std::size_t k) { return settled.held(k); })) {
    if (plateau.time.size() < kLeastHeldSamples) continue;
    const SlopeSums sums = sums_of(plateau);
    if (sums.largest_departure < kTableRate) continue;
    const double uncertainty = slope_uncertainty(plateau, sums);
    if (uncertainty <= kMostSlopeUncertainty)
      slopes.push_back({slope_of(plateau, sums), uncertainty});
  }
  return slopes;
}

std::optional<double> share_retained(const SlopeSums& sums) {
  if (sums.largest_departure < kLeastRateDeparture) return std::nullopt;
  return sums.compensated / sums.raw;
}

}  // namespace beamgyro::internal
