// SPDX-License-Identifier: MIT
#include "validation/metrics/noisy_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <utility>

#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint32_t kDraws = 300;
constexpr double kFirstNoise = 1.0 + std::numbers::sqrt2;  // 1/(sqrt(2) - 1)
constexpr double kSmallNoise = 1e-4;  // [-], too little to choose another one
constexpr double kNormal995 = 2.5758293035489004;  // [-], normal quantile
constexpr double kRounding = 1e-9;                 // [-], of a figure
constexpr int kRootHalvings = 40;                  // of a bracket
constexpr std::size_t kKeptDraws = 8;

double mean_square(std::span<const double> values, double about) {
  double sum = 0.0;
  for (const double value : values) sum += (value - about) * (value - about);
  return sum / static_cast<double>(values.size());
}

/// Ends of the means since each power-on of each run.
std::vector<std::size_t> power_on_ends(const NoisyMeans& means) {
  std::vector<std::size_t> ends;
  std::size_t end = 0;
  for (const std::size_t size : means.sizes) {
    for (std::size_t i = end + 1; i < end + size; ++i)
      if (means.segments[i].power_on != means.segments[i - 1].power_on)
        ends.push_back(i);
    end += size;
    ends.push_back(end);
  }
  return ends;
}

/// Calls `each(index, centre)` for every value with what it is drawn towards.
template <typename Each>
void for_each_about_centre(std::span<const double> values,
                           const std::vector<std::size_t>& ends,
                           Shrinkage shrinkage, const Each& each) {
  std::size_t i = 0;
  for (const std::size_t end : ends) {
    const double centre = shrinkage == Shrinkage::kToZero
                              ? 0.0
                              : mean_of(values.subspan(i, end - i));
    for (; i < end; ++i) each(i, centre);
  }
}

double sum_of_squares(std::span<const double> values,
                      const std::vector<std::size_t>& ends,
                      Shrinkage shrinkage) {
  double sum = 0.0;
  for_each_about_centre(values, ends, shrinkage,
                        [&](std::size_t i, double centre) {
                          sum += (values[i] - centre) * (values[i] - centre);
                        });
  return sum;
}

std::vector<double> shrunken(const NoisyMeans& means, const Draws& draws,
                             Shrinkage shrinkage) {
  std::vector<double> base = means.values;
  if (shrinkage == Shrinkage::kNone) return base;
  const std::vector<std::size_t> ends = {base.size()};
  std::vector<double> noise;  // sums of squares
  for (const std::vector<double>& draw : draws)
    noise.push_back(sum_of_squares(draw, ends, shrinkage));
  const double usual = mean_of(noise);
  const double most = usual + kNormal975 * std::sqrt(mean_square(noise, usual));
  const double all = sum_of_squares(base, ends, shrinkage);
  // As small a sum may well be noise alone.
  const double kept = all > most ? std::sqrt(1.0 - usual / all) : 0.0;
  for_each_about_centre(means.values, ends, shrinkage,
                        [&](std::size_t i, double centre) {
                          base[i] = centre + kept * (base[i] - centre);
                        });
  return base;
}

/// The figure of `base` with each draw, `factor` times as large.
std::vector<double> figures_with(const Draws& draws,
                                 const std::vector<double>& base,
                                 const Statistic& statistic,
                                 double factor = 1.0) {
  std::vector<double> figures;
  std::vector<double> noisy(base.size());
  for (const std::vector<double>& draw : draws) {
    std::ranges::transform(
        base, draw, noisy.begin(),
        [factor](double mean, double noise) { return mean + factor * noise; });
    figures.push_back(statistic(noisy));
  }
  return figures;
}

/// Half the 95 % interval of a figure whose choice of means the noise leaves as
/// it is.
double half_without_choice(const NoisyMeans& means, const Draws& draws,
                           const Statistic& statistic) {
  const std::vector<double> figures =
      figures_with(draws, means.values, statistic, kSmallNoise);
  const double mean = mean_of(figures);
  const double half =
      kNormal975 / kSmallNoise * std::sqrt(mean_square(figures, mean));
  return half > kRounding * std::abs(mean) ? half : 0.0;
}

/// The interval about a figure by its errors, as the header says.
Interval interval_by_errors(double figure, std::span<const double> errors,
                            Growth growth) {
  const double shift = mean_of(errors);
  const double half = kNormal975 * std::sqrt(mean_square(errors, shift));
  const double first =
      growth == Growth::kExtreme ? std::max(shift, kFirstNoise * shift) : shift;
  return {figure - first - half, figure - shift + half};
}

/// What draws of the noise change a figure of `base` by.
std::vector<double> errors_about(const std::vector<double>& base,
                                 const Draws& draws,
                                 const Statistic& statistic) {
  std::vector<double> errors = figures_with(draws, base, statistic);
  const double exact = statistic(base);
  for (double& error : errors) error -= exact;
  return errors;
}

/// The square of a figure of t times a drift and a draw of noise: drift t^2 +
/// product t + noise.
struct NoisySquare {
  double drift;
  std::vector<double> products, noise;  // of each draw
};

NoisySquare noisy_square(const std::vector<double>& drift, const Draws& draws,
                         const Statistic& root) {
  const std::vector<double> nothing(drift.size(), 0.0);
  NoisySquare found{std::pow(root(drift), 2), figures_with(draws, drift, root),
                    figures_with(draws, nothing, root)};
  for (std::size_t d = 0; d < draws.size(); ++d) {
    found.noise[d] *= found.noise[d];
    found.products[d] =
        std::pow(found.products[d], 2) - found.drift - found.noise[d];
  }
  return found;
}

/// A quantile of the square, which is skewed a little.
double quantile_of(const NoisySquare& square, double t, double normal) {
  std::vector<double> values(square.noise.size());
  for (std::size_t d = 0; d < values.size(); ++d)
    values[d] = square.drift * t * t + square.products[d] * t + square.noise[d];
  const double mean = mean_of(values);
  const double sigma = std::sqrt(mean_square(values, mean));
  if (!(sigma > 0.0)) return mean;
  double cubes = 0.0;
  for (const double value : values) cubes += std::pow(value - mean, 3);
  const double skewness =
      cubes / (static_cast<double>(values.size()) * sigma * sigma * sigma);
  return mean + sigma * (normal + (normal * normal - 1.0) * skewness / 6.0);
}

/// The figure of the drift for which a quantile is the square that was seen;
/// zero if the noise alone has so large a quantile.
double root_by_quantile(const NoisySquare& square, double seen, double normal) {
  if (!(square.drift > 0.0) || quantile_of(square, 0.0, normal) >= seen)
    return 0.0;
  double low = 0.0, high = 1.0;
  while (quantile_of(square, high, normal) < seen) high *= 2.0;
  for (int i = 0; i < kRootHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (quantile_of(square, middle, normal) < seen ? low : high) = middle;
  }
  return high * std::sqrt(square.drift);
}

/// The means and one standard deviation of the noise that has most in common
/// with them.
std::vector<double> nearer_to_noise(std::vector<double> means,
                                    const NoisySquare& square,
                                    const Draws& draws) {
  const double all = std::sqrt(mean_square(square.products, 0.0));
  if (!(all > 0.0)) return means;
  const double factor = 1.0 / (all * static_cast<double>(draws.size()));
  for (std::size_t d = 0; d < draws.size(); ++d)
    for (std::size_t i = 0; i < means.size(); ++i)
      means[i] += factor * square.products[d] * draws[d][i];
  return means;
}

/// Ends of windows of one power-on of one run, none longer than `window` [s].
std::vector<std::size_t> window_ends(const NoisyMeans& means, double window) {
  std::vector<std::size_t> ends;
  std::size_t begin = 0;
  for (const std::size_t power_on : power_on_ends(means)) {
    for (std::size_t i = begin + 1; i < power_on; ++i)
      if (means.segments[i].time - means.segments[begin].time >= window) {
        ends.push_back(i);
        begin = i;
      }
    ends.push_back(power_on);
    begin = power_on;
  }
  return ends;
}

/// The draws that were asked for last.
class KeptDraws {
 public:
  /// Makes the draws once, however many threads ask for them.
  std::shared_ptr<const Draws> of(const NoisyMeans& means) {
    const std::shared_ptr<Kept> one = place_of(means);
    std::call_once(one->made, [&] {
      one->draws.clear();
      for (std::uint32_t d = 0; d < kDraws; ++d)
        one->draws.push_back(means.drawn_noise(d));
    });
    return {one, &one->draws};
  }

 private:
  struct Kept {
    std::vector<SegmentNoise> noise;
    std::once_flag made;
    Draws draws;
  };

  std::shared_ptr<Kept> place_of(const NoisyMeans& means) {
    const std::lock_guard lock(mutex_);
    for (const std::shared_ptr<Kept>& one : kept_)
      if (one && one->noise == means.noise) return one;
    std::shared_ptr<Kept>& place = kept_.at(next_);
    next_ = (next_ + 1) % kept_.size();
    place = std::make_shared<Kept>();
    place->noise = means.noise;
    return place;
  }

  std::mutex mutex_;
  std::array<std::shared_ptr<Kept>, kKeptDraws> kept_;
  std::size_t next_ = 0;
};

}  // namespace

void NoisyMeans::add(const EvidenceRun& run,
                     std::span<const SampleRange> ranges,
                     std::span<const double> signal) {
  const std::vector<double> residual = residual_of(run);
  const std::vector<Segment> more = segments_of(*run.recording, ranges);
  const std::vector<double> means =
      means_over(more, signal.empty() ? residual : signal);
  noise.emplace_back(seen_noise(*run.recording, residual), more);
  sizes.push_back(more.size());
  segments.insert(segments.end(), more.begin(), more.end());
  values.insert(values.end(), means.begin(), means.end());
}

std::vector<double> NoisyMeans::drawn_noise(std::uint32_t draw) const {
  std::vector<double> drawn(values.size());
  std::size_t first = 0;
  for (std::size_t run = 0; run < noise.size(); ++run) {
    RandomStream random(0, draw, static_cast<std::uint32_t>(run),
                        kIntervalStream);
    noise[run].draw(random, std::span(drawn).subspan(first, sizes[run]));
    first += sizes[run];
  }
  return drawn;
}

bool NoisyMeans::without_noise() const {
  return std::ranges::all_of(noise, &SegmentNoise::none);
}

std::shared_ptr<const Draws> draws_of(const NoisyMeans& means) {
  static KeptDraws kept;
  return kept.of(means);
}

bool lacks_answers(const NoisyMeans& means) {
  return !std::ranges::all_of(means.values,
                              [](double v) { return std::isfinite(v); });
}

Estimate estimate_beneath_noise(const NoisyMeans& means,
                                const Statistic& statistic, Shrinkage shrinkage,
                                double least, Growth growth) {
  if (lacks_answers(means)) return {NAN};
  const double value = statistic(means.values);
  if (means.without_noise() || !std::isfinite(value))
    return {value, Interval{value, value}};
  const auto kept_draws = draws_of(means);
  const Draws& draws = *kept_draws;
  auto [low, high] = interval_by_errors(
      value, errors_about(shrunken(means, draws, shrinkage), draws, statistic),
      growth);
  if (growth == Growth::kExtreme)
    high = std::max(high, value + half_without_choice(means, draws, statistic));
  return {value, Interval{std::min(value, std::max(least, low)),
                          std::max(value, high)}};
}

Estimate estimate_of_range(const NoisyMeans& means, const Statistic& range) {
  return estimate_beneath_noise(means, range, Shrinkage::kToMean, 0.0,
                                Growth::kExtreme);
}

Estimate estimate_of_root(const NoisyMeans& means, const Statistic& root) {
  if (lacks_answers(means)) return {NAN};
  const double value = root(means.values);
  if (means.without_noise() || !std::isfinite(value))
    return {value, Interval{value, value}};
  const auto kept_draws = draws_of(means);
  const Draws& draws = *kept_draws;
  const NoisySquare square = noisy_square(means.values, draws, root);
  const NoisySquare nearer =
      noisy_square(nearer_to_noise(means.values, square, draws), draws, root);
  const double low = root_by_quantile(square, square.drift, kNormal975);
  const double high = root_by_quantile(nearer, square.drift, -kNormal975);
  return {value, Interval{std::min(value, low), std::max(value, high)}};
}

double rms_within(const NoisyMeans& means, double window) {
  return std::sqrt(sum_of_squares(means.values, window_ends(means, window),
                                  Shrinkage::kToMean) /
                   static_cast<double>(means.values.size()));
}

double least_rms_within(const NoisyMeans& means, double window) {
  const auto draws = draws_of(means);
  const std::vector<std::size_t> ends = window_ends(means, window);
  const auto count = static_cast<double>(means.values.size());
  NoisySquare square{
      sum_of_squares(means.values, ends, Shrinkage::kToMean) / count, {}, {}};
  for (const std::vector<double>& draw : *draws) {
    square.noise.push_back(sum_of_squares(draw, ends, Shrinkage::kToMean) /
                           count);
    double& product = square.products.emplace_back(0.0);
    for_each_about_centre(means.values, ends, Shrinkage::kToMean,
                          [&](std::size_t i, double centre) {
                            product += 2.0 / count *
                                       (means.values[i] - centre) * draw[i];
                          });
  }
  return root_by_quantile(square, square.drift, kNormal995);
}

Estimate estimate_of_noise(const NoisyMeans& means,
                           const Statistic& statistic) {
  if (lacks_answers(means)) return {NAN};
  const double value = statistic(means.values);
  if (means.without_noise() || !(value > 0.0) || !std::isfinite(value))
    return {value, Interval{value, value}};
  const auto kept_draws = draws_of(means);
  const Draws& draws = *kept_draws;
  const std::vector<double> nothing(means.values.size(), 0.0);
  const double noise =
      mean_square(figures_with(draws, nothing, statistic), 0.0);
  const double kept =
      value * value > noise ? std::sqrt(1.0 - noise / (value * value)) : 0.0;
  std::vector<double> base = means.values;
  for (double& v : base) v *= kept;
  const double exact = std::sqrt(std::pow(statistic(base), 2) + noise);
  std::vector<double> errors = figures_with(draws, base, statistic);
  for (double& error : errors) error = std::log(error / exact);
  const double shift = mean_of(errors);
  const double half = kNormal975 * std::sqrt(mean_square(errors, shift));
  return {value, Interval{std::min(value, value * std::exp(-shift - half)),
                          std::max(value, value * std::exp(-shift + half))}};
}

}  // namespace beamgyro::internal
