// SPDX-License-Identifier: MIT
#include "validation/metrics/noisy_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint32_t kDraws = 300;
constexpr double kFirstNoise = 1.0 + std::numbers::sqrt2;  // 1/(sqrt(2) - 1)
constexpr double kSmallNoise = 1e-4;  // [-], too little to choose another one
constexpr double kNormal995 = 2.5758293035489004;  // [-], normal quantile
constexpr double kRounding = 1e-9;                 // [-], of a figure

using Draws = std::vector<std::vector<double>>;

double mean_square(std::span<const double> values, double about) {
  double sum = 0.0;
  for (const double value : values) sum += (value - about) * (value - about);
  return sum / static_cast<double>(values.size());
}

/// Ends of the ranges of means that are drawn towards one value.
std::vector<std::size_t> group_ends(const NoisyMeans& means,
                                    Shrinkage shrinkage) {
  std::vector<std::size_t> ends;
  if (shrinkage == Shrinkage::kToPowerOn) {
    std::size_t end = 0;
    for (const std::size_t size : means.sizes) {
      for (std::size_t i = end + 1; i < end + size; ++i)
        if (means.segments[i].power_on != means.segments[i - 1].power_on)
          ends.push_back(i);
      end += size;
      ends.push_back(end);
    }
  } else {
    ends.push_back(means.values.size());
  }
  return ends;
}

std::vector<double> centres_of(std::span<const double> values,
                               const std::vector<std::size_t>& ends,
                               Shrinkage shrinkage) {
  std::vector<double> centres(values.size(), 0.0);
  if (shrinkage == Shrinkage::kToZero) return centres;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    const double centre = mean_of(values.subspan(begin, end - begin));
    std::fill(centres.begin() + static_cast<std::ptrdiff_t>(begin),
              centres.begin() + static_cast<std::ptrdiff_t>(end), centre);
    begin = end;
  }
  return centres;
}

double sum_of_squares(std::span<const double> values,
                      std::span<const double> centres) {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
    sum += (values[i] - centres[i]) * (values[i] - centres[i]);
  return sum;
}

std::vector<double> shrunken(const NoisyMeans& means, const Draws& draws,
                             Shrinkage shrinkage) {
  std::vector<double> base = means.values;
  if (shrinkage == Shrinkage::kNone) return base;
  const std::vector<std::size_t> ends = group_ends(means, shrinkage);
  std::vector<double> noise;  // sums of squares
  for (const std::vector<double>& draw : draws)
    noise.push_back(sum_of_squares(draw, centres_of(draw, ends, shrinkage)));
  const double usual = mean_of(noise);
  const double most = usual + kNormal975 * std::sqrt(mean_square(noise, usual));
  const std::vector<double> centres = centres_of(base, ends, shrinkage);
  const double all = sum_of_squares(base, centres);
  // As small a sum may well be noise alone.
  const double kept = all > most ? std::sqrt(1.0 - usual / all) : 0.0;
  for (std::size_t i = 0; i < base.size(); ++i)
    base[i] = centres[i] + kept * (base[i] - centres[i]);
  return base;
}

std::vector<double> figures_with(const Draws& draws,
                                 const std::vector<double>& base,
                                 const Statistic& statistic) {
  std::vector<double> figures;
  std::vector<double> noisy(base.size());
  for (const std::vector<double>& draw : draws) {
    std::ranges::transform(base, draw, noisy.begin(), std::plus<>());
    figures.push_back(statistic(noisy));
  }
  return figures;
}

/// Half the 95 % interval of a figure whose choice of means the noise leaves as
/// it is.
double half_without_choice(const NoisyMeans& means, const Draws& draws,
                           const Statistic& statistic) {
  Draws small = draws;
  for (std::vector<double>& draw : small)
    for (double& noise : draw) noise *= kSmallNoise;
  const std::vector<double> figures =
      figures_with(small, means.values, statistic);
  const double mean = mean_of(figures);
  const double half =
      kNormal975 / kSmallNoise * std::sqrt(mean_square(figures, mean));
  return half > kRounding * std::abs(mean) ? half : 0.0;
}

/// The interval about a figure by its errors, as the header says.
Interval interval_by_errors(double figure, std::span<const double> errors,
                            Growth growth, double normal) {
  const double shift = mean_of(errors);
  const double half = normal * std::sqrt(mean_square(errors, shift));
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

/// The lower end of the root of a mean square by its figure and errors of it.
double low_root(double square, std::span<const double> errors, double normal) {
  return std::sqrt(std::max(
      0.0, interval_by_errors(square, errors, Growth::kSquare, normal).low));
}

/// The quantile of a distribution that is skewed a little.
double lower_quantile(std::span<const double> values, double normal) {
  const double mean = mean_of(values);
  const double sigma = std::sqrt(mean_square(values, mean));
  if (!(sigma > 0.0)) return mean;
  double cubes = 0.0;
  for (const double value : values) cubes += std::pow(value - mean, 3);
  const double skewness =
      cubes / (static_cast<double>(values.size()) * sigma * sigma * sigma);
  return mean + sigma * (-normal + (normal * normal - 1.0) * skewness / 6.0);
}

/// `base` and `normal` standard deviations of the noise that enlarges a mean
/// square of it most, as the header says.
std::vector<double> lessened_by_noise(std::vector<double> base,
                                      const Draws& draws,
                                      const Statistic& square, double normal) {
  std::vector<double> opposite(base.size());
  std::vector<double> shares = figures_with(draws, base, square);
  double squares = 0.0;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    std::ranges::transform(base, draws[d], opposite.begin(), std::minus<>());
    shares[d] -= square(opposite);
    squares += shares[d] * shares[d];
  }
  if (!(squares > 0.0)) return base;
  const auto count = static_cast<double>(draws.size());
  const double factor = normal / std::sqrt(squares * count);
  for (std::size_t d = 0; d < draws.size(); ++d)
    for (std::size_t i = 0; i < base.size(); ++i)
      base[i] += factor * shares[d] * draws[d][i];
  return base;
}

/// The interval of the root of a mean square.
Interval root_interval(const NoisyMeans& means, const Draws& draws,
                       const Statistic& statistic, Shrinkage shrinkage) {
  const Statistic square = [&](std::span<const double> b) {
    const double figure = statistic(b);
    return figure * figure;
  };
  const double found = square(means.values);
  std::vector<double> base = shrunken(means, draws, shrinkage);
  const double low =
      low_root(found, errors_about(base, draws, square), kNormal975);
  if (!(square(base) > kRounding * found)) base = means.values;
  const std::vector<double> least =
      lessened_by_noise(std::move(base), draws, square, kNormal975);
  const double high =
      found - lower_quantile(errors_about(least, draws, square), kNormal975);
  return {low, std::sqrt(std::max(high, 0.0))};
}

/// Ends of windows of one power-on of one run, none longer than `window` [s].
std::vector<std::size_t> window_ends(const NoisyMeans& means, double window) {
  std::vector<std::size_t> ends;
  std::size_t begin = 0;
  for (const std::size_t power_on : group_ends(means, Shrinkage::kToPowerOn)) {
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

std::vector<double> less_means(std::span<const double> values,
                               const std::vector<std::size_t>& ends) {
  const std::vector<double> centres =
      centres_of(values, ends, Shrinkage::kToMean);
  std::vector<double> centred(values.size());
  std::ranges::transform(values, centres, centred.begin(), std::minus<>());
  return centred;
}

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

const Draws& draws_of(const NoisyMeans& means) {
  struct Kept {
    std::vector<SegmentNoise> noise;
    Draws draws;
  };
  thread_local std::array<Kept, 6> kept;
  thread_local std::size_t next = 0;
  for (const Kept& one : kept)
    if (one.noise == means.noise) return one.draws;
  Kept& place = kept.at(next);
  next = (next + 1) % kept.size();
  place.draws.clear();
  for (std::uint32_t d = 0; d < kDraws; ++d)
    place.draws.push_back(means.drawn_noise(d));
  place.noise = means.noise;
  return place.draws;
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
  const Draws& draws = draws_of(means);
  auto [low, high] =
      growth == Growth::kSquare
          ? root_interval(means, draws, statistic, shrinkage)
          : interval_by_errors(value,
                               errors_about(shrunken(means, draws, shrinkage),
                                            draws, statistic),
                               growth, kNormal975);
  if (growth == Growth::kExtreme)
    high = std::max(high, value + half_without_choice(means, draws, statistic));
  return {value, Interval{std::min(value, std::max(least, low)),
                          std::max(value, high)}};
}

double least_rms_within(const NoisyMeans& means, double window) {
  const std::vector<std::size_t> ends = window_ends(means, window);
  NoisyMeans centred = means;
  centred.values = less_means(means.values, ends);
  Draws draws;
  for (const std::vector<double>& draw : draws_of(means))
    draws.push_back(less_means(draw, ends));
  const Statistic square = [](std::span<const double> b) {
    return mean_square(b, 0.0);
  };
  return low_root(
      square(centred.values),
      errors_about(shrunken(centred, draws, Shrinkage::kToZero), draws, square),
      kNormal995);
}

Estimate estimate_of_noise(const NoisyMeans& means,
                           const Statistic& statistic) {
  if (lacks_answers(means)) return {NAN};
  const double value = statistic(means.values);
  if (means.without_noise() || !(value > 0.0) || !std::isfinite(value))
    return {value, Interval{value, value}};
  const Draws& draws = draws_of(means);
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
