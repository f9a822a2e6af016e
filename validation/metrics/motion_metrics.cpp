// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "compensation/scoring/scale_factor.h"
#include "config/units.h"
#include "linear_algebra/least_squares.h"
#include "validation/metrics/largest_figure.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/noisy_means.h"

namespace beamgyro::internal {
namespace {

constexpr double kMotionBlock = 10.0;     // [s]
constexpr double kShortBlock = 0.1;       // [s], for cross rates that swing
constexpr double kDrift = 300.0;          // [s], between knots of the drift
constexpr double kBeforeTurns = 300.0;    // [s]
constexpr double kLeastSquareSum = 1e-9;  // [-], of a term that is determined
constexpr double kPercent = 100.0;

/// Columns of a regression, one row for each segment.
struct Terms {
  Eigen::MatrixXd searched, drift;
};

/// Weights w_k of sum_k w_k y_k, the coefficient of one searched term; empty
/// when the other terms determine it.
std::vector<double> weights_of(const Terms& terms, Eigen::Index term) {
  const Eigen::Index rows = terms.searched.rows();
  Eigen::MatrixXd others(rows, terms.drift.cols() + terms.searched.cols() - 1);
  others << terms.drift, terms.searched.leftCols(term),
      terms.searched.rightCols(terms.searched.cols() - term - 1);
  // Terms that are zero throughout, or equal, are dropped by the pivoting.
  const Eigen::VectorXd column = terms.searched.col(term);
  const Eigen::VectorXd left =
      column - others * least_norm_solution(others, column);
  const double squares = left.squaredNorm();
  if (!(squares > kLeastSquareSum * column.squaredNorm())) return {};
  std::vector<double> weights(static_cast<std::size_t>(rows));
  Eigen::VectorXd::Map(weights.data(), rows) = left / squares;
  return weights;
}

std::optional<Estimate> weighted_sum(const NoisyMeans& means,
                                     const std::vector<double>& weights) {
  if (weights.empty()) return std::nullopt;
  return estimate_beneath_noise(
      means,
      [&](std::span<const double> b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < b.size(); ++i) sum += weights[i] * b[i];
        return sum;
      },
      Shrinkage::kNone);
}

/// A drift between knots, one hat for each.
Eigen::MatrixXd hats(std::span<const Segment> segments, double knots) {
  const double first = segments.front().time;
  const double last = segments.back().time;
  const auto pieces = std::max<Eigen::Index>(
      1, static_cast<Eigen::Index>((last - first) / knots));
  const double piece = (last - first) / static_cast<double>(pieces);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(
      static_cast<Eigen::Index>(segments.size()), pieces + 1);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double place = (segments[i].time - first) / piece;
    const auto left = std::min(static_cast<Eigen::Index>(place), pieces - 1);
    const double share = place - static_cast<double>(left);
    all(static_cast<Eigen::Index>(i), left) = 1.0 - share;
    all(static_cast<Eigen::Index>(i), left + 1) = share;
  }
  return all;
}

std::vector<double> column_or_zero(const Recording& recording, const char* name,
                                   double unit) {
  const Column* column = find_column(recording, name);
  if (column == nullptr) return std::vector<double>(recording.time.size(), 0.0);
  std::vector<double> values = column->values;
  for (double& value : values) value /= unit;
  return values;
}

struct Acceleration {
  std::array<std::vector<double>, 3> axes;  // [g]
  std::vector<double> square;               // [g^2]
};

Acceleration acceleration_of(const Recording& recording) {
  Acceleration a{
      {column_or_zero(recording, "true_acceleration_x", kStandardGravity),
       column_or_zero(recording, "true_acceleration_y", kStandardGravity),
       column_or_zero(recording, "true_acceleration_z", kStandardGravity)},
      std::vector<double>(recording.time.size(), 0.0)};
  for (const auto& axis : a.axes)
    for (std::size_t k = 0; k < axis.size(); ++k)
      a.square[k] += axis[k] * axis[k];
  return a;
}

void put_column(Eigen::MatrixXd& matrix, Eigen::Index column,
                std::span<const Segment> segments,
                std::span<const double> values) {
  const std::vector<double> means = means_over(segments, values);
  matrix.col(column) = Eigen::VectorXd::Map(
      means.data(), static_cast<Eigen::Index>(means.size()));
}

/// Coefficient of acceleration along x, y, z (0, 1, 2) or of its square (3).
std::optional<Estimate> acceleration_term(const Evidence& evidence,
                                          RunPurpose purpose,
                                          Eigen::Index term) {
  for (const EvidenceRun* run : runs_for(evidence, {purpose})) {
    const Recording& recording = *run->recording;
    const Acceleration a = acceleration_of(recording);
    std::vector<SampleRange> ranges;
    // Blocks over which the acceleration is held, or any in a vibration.
    if (purpose == RunPurpose::kTumble) {
      for (const SampleRange& held : held_ranges(
               recording, std::array{&a.axes[0], &a.axes[1], &a.axes[2]})) {
        const SampleRange range = settled(recording, held, kSettlingTime);
        if (range.size() > 0) ranges.push_back(range);
      }
    } else {
      ranges = score_blocks(recording, kMotionBlock);
    }
    if (ranges.size() < 3) continue;
    NoisyMeans means;
    means.add(*run, ranges);
    const bool with_square = purpose == RunPurpose::kVibration;
    const auto rows = static_cast<Eigen::Index>(ranges.size());
    const Eigen::MatrixXd drift = hats(means.segments, kDrift);
    Terms terms{Eigen::MatrixXd(rows, with_square ? 4 : 3),
                Eigen::MatrixXd(rows, drift.cols() + 2)};
    terms.drift.leftCols(drift.cols()) = drift;
    put_column(terms.drift, drift.cols(), means.segments,
               column_or_zero(recording, "true_cross_rate_x", 1.0));
    put_column(terms.drift, drift.cols() + 1, means.segments,
               column_or_zero(recording, "true_cross_rate_y", 1.0));
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      put_column(terms.searched, axis, means.segments,
                 a.axes[static_cast<std::size_t>(axis)]);
    if (with_square) put_column(terms.searched, 3, means.segments, a.square);
    if (const auto found = weighted_sum(means, weights_of(terms, term)))
      return found;
  }
  return std::nullopt;
}

double variance_of(std::span<const double> values) {
  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), n);
  return (all - all.mean()).square().mean();
}

/// The turns of a run about the cross axes [deg/s], and from when on there are
/// any.
struct CrossRates {
  std::array<std::vector<double>, 2> axes;
  std::vector<SampleRange> ranges;  // of means
};

std::optional<CrossRates> cross_rates_of(const Recording& recording) {
  CrossRates found{{column_or_zero(recording, "true_cross_rate_x", 1.0),
                    column_or_zero(recording, "true_cross_rate_y", 1.0)},
                   {}};
  std::size_t first = 0;
  while (first < recording.time.size() &&
         found.axes[0][first] == found.axes[0][0] &&
         found.axes[1][first] == found.axes[1][0])
    ++first;
  if (first == recording.time.size()) return std::nullopt;
  const double from = recording.time[first] - kBeforeTurns;
  for (const double length : {kMotionBlock, kShortBlock}) {
    found.ranges =
        score_blocks(recording, std::max(length, 2.0 * usual_step(recording)));
    std::erase_if(found.ranges, [&](const SampleRange& range) {
      return recording.time[range.begin] < from;
    });
    const auto segments = segments_of(recording, found.ranges);
    bool seen = found.ranges.size() > 3;
    for (const auto& axis : found.axes) {
      const std::vector<double> means = means_over(segments, axis);
      seen = seen && variance_of(means) >= 0.5 * variance_of(axis);
    }
    if (seen) break;
  }
  return found;
}

std::optional<Estimate> cross_axis(const Evidence& evidence) {
  std::optional<Estimate> largest;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kVibration})) {
    const Recording& recording = *run->recording;
    const auto turns = cross_rates_of(recording);
    if (!turns || turns->ranges.size() < 4) continue;
    const Acceleration a = acceleration_of(recording);
    NoisyMeans means;
    means.add(*run, turns->ranges);
    const auto rows = static_cast<Eigen::Index>(means.segments.size());
    Terms terms{Eigen::MatrixXd(rows, 2), Eigen::MatrixXd(rows, 6)};
    terms.drift.leftCols(2) = hats(means.segments, HUGE_VAL);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      put_column(terms.drift, 2 + axis, means.segments,
                 a.axes[static_cast<std::size_t>(axis)]);
    put_column(terms.drift, 5, means.segments, a.square);
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      put_column(terms.searched, axis, means.segments,
                 turns->axes[static_cast<std::size_t>(axis)]);
    std::array<std::vector<double>, 2> weights = {weights_of(terms, 0),
                                                  weights_of(terms, 1)};
    if (weights[0].empty() && weights[1].empty()) continue;
    const Estimate found =
        estimate_of_largest(means, [&](std::span<const double> b) {
          std::vector<double> slopes;
          for (const auto& w : weights) {
            double sum = 0.0;
            for (std::size_t i = 0; i < w.size(); ++i) sum += w[i] * b[i];
            slopes.push_back(kPercent * sum);
          }
          return slopes;
        });
    if (!largest || found.value > largest->value) largest = found;
  }
  return largest;
}

std::optional<Estimate> extrapolated_share(const Evidence& evidence) {
  std::size_t clamped = 0, powered = 0;
  for (const EvidenceRun& run : evidence.runs) {
    if (!run.clamped) continue;
    clamped += *run.clamped;
    for (const SampleRange& stretch : powered_stretches(*run.recording))
      powered += stretch.size();
  }
  if (powered == 0) return std::nullopt;
  const double share =
      kPercent * static_cast<double>(clamped) / static_cast<double>(powered);
  return Estimate{share, Interval{share, share}};
}

}  // namespace

std::vector<Metric> motion_metrics() {
  using enum RunPurpose;
  return {
      {"g_sensitivity_x_deg_per_s_per_g",
       "Sensitivity to acceleration along x",
       "deg/s/g",
       "",
       "(B(+g) - B(-g)) / 2 along x: slope of the least-squares plane "
       "of the residual over the acceleration.",
       {kTumble},
       given(acceleration_term, kTumble, 0)},
      {"g_sensitivity_y_deg_per_s_per_g",
       "Sensitivity to acceleration along y",
       "deg/s/g",
       "",
       "g_sensitivity_x_deg_per_s_per_g, but along y.",
       {kTumble},
       given(acceleration_term, kTumble, 1)},
      {"g_sensitivity_z_deg_per_s_per_g",
       "Sensitivity to acceleration along z",
       "deg/s/g",
       "",
       "g_sensitivity_x_deg_per_s_per_g, but along z.",
       {kTumble},
       given(acceleration_term, kTumble, 2)},
      {"vibration_rectification_deg_per_s_per_g2",
       "Vibration rectification",
       "deg/s/g^2",
       "",
       "Slope of the residual over the mean square of the acceleration, "
       "beside its mean.",
       {kVibration},
       given(acceleration_term, kVibration, 3)},
      {"cross_axis_percent",
       "Cross-axis sensitivity",
       "%",
       "12.12",
       "Largest slope of the residual over the true rate about a cross "
       "axis.",
       {kVibration},
       cross_axis},
      {"extrapolated_share_percent",
       "Samples outside the training range",
       "%",
       "",
       "Samples outside what training saw, of all powered samples.",
       {kSoak, kRamp, kWarmUp, kPowerCycle, kRateTable, kConstantRate,
        kSineRate, kRateStep, kRest, kTumble, kRandomRate, kVibration},
       extrapolated_share},
  };
}

}  // namespace beamgyro::internal
