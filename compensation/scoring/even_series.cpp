// SPDX-License-Identifier: MIT
#include "compensation/scoring/even_series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/inputs/sample_ranges.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kMostPlacesPerSample = 4;
constexpr std::size_t kBlockSteps = 64, kLeastBlockSteps = 16;

/// Indices of the usable samples of each stretch with power.
std::vector<std::vector<std::size_t>> usable_samples(
    const Recording& recording, const std::vector<double>& values,
    const TimeWindow& window) {
  std::vector<std::vector<std::size_t>> stretches;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    std::vector<std::size_t> usable;
    usable.reserve(stretch.size());
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const double t = recording.time[k];
      if (std::isfinite(values[k]) && t >= window.from && t <= window.to)
        usable.push_back(k);
    }
    if (usable.size() > 1) stretches.push_back(std::move(usable));
  }
  return stretches;
}

/// Mean of the steps no longer than `longest` [s]; 0 when there is none.
double mean_step(const std::vector<double>& time,
                 const std::vector<std::vector<std::size_t>>& stretches,
                 double longest) {
  double duration = 0.0;
  std::size_t steps = 0;
  for (const auto& usable : stretches) {
    for (std::size_t begin = 0, i = 1; i <= usable.size(); ++i) {
      if (i < usable.size() && time[usable[i]] - time[usable[i - 1]] <= longest)
        continue;
      duration += time[usable[i - 1]] - time[usable[begin]];
      steps += i - 1 - begin;
      begin = i;
    }
  }
  return steps > 0 ? duration / static_cast<double>(steps) : 0.0;
}

/// How far steps depart from the places that they are given.
class Evenness {
 public:
  explicit Evenness(double interval) : interval_(interval) {}

  void add(double duration, double places) {
    duration_ += duration;
    places_ += places;
    if (++steps_ == kBlockSteps) end_block();
  }

  void end_block() {
    if (steps_ >= kLeastBlockSteps) {
      departures_ += std::abs(duration_ - places_ * interval_);
      durations_ += duration_;
    }
    duration_ = places_ = 0.0;
    steps_ = 0;
  }

  double departure() const {
    return durations_ > 0.0 ? departures_ / durations_ : 0.0;
  }

 private:
  double interval_;
  double duration_ = 0.0, places_ = 0.0;
  std::size_t steps_ = 0;
  double departures_ = 0.0, durations_ = 0.0;
};

/// Fills the stretches of a series whose interval is known.
class Grid {
 public:
  Grid(const std::vector<double>& time, const std::vector<double>& values,
       EvenSeries& series)
      : time_(time),
        values_(values),
        series_(series),
        evenness_(series.interval) {}

  void add(const std::vector<std::size_t>& usable) {
    for (std::size_t i = 0; i < usable.size(); ++i) {
      if (i > 0) step(time_[usable[i]] - time_[usable[i - 1]]);
      places_.push_back(values_[usable[i]]);
      if (samples_++ == 0) start_ = usable[i];
      end_ = usable[i];
    }
    close();
    series_.unevenness = evenness_.departure();
  }

 private:
  /// Places without a sample before the next one, or the end of the stretch.
  void step(double duration) {
    const double steps = std::round(duration / series_.interval);
    const double most = static_cast<double>(kMostPlacesPerSample * samples_);
    if (static_cast<double>(places_.size()) + steps - 1.0 > most) {
      close();
    } else {
      evenness_.add(duration, std::max(steps, 1.0));
      places_.resize(
          places_.size() + static_cast<std::size_t>(std::max(steps, 1.0)) - 1,
          NAN);
    }
  }

  void close() {
    if (samples_ > 1) {
      if (series_.samples == 0) series_.first = time_[start_];
      series_.last = time_[end_];
      series_.samples += samples_;
      series_.missing += places_.size() - samples_;
      series_.stretches.push_back(std::move(places_));
    }
    places_.clear();
    samples_ = 0;
    evenness_.end_block();
  }

  const std::vector<double>& time_;
  const std::vector<double>& values_;
  EvenSeries& series_;
  Evenness evenness_;
  std::vector<double> places_;
  std::size_t samples_ = 0, start_ = 0, end_ = 0;
};

}  // namespace

EvenSeries even_series(const Recording& recording, std::string_view name,
                       const TimeWindow& window) {
  const auto& values = column_values(recording, name);
  const auto stretches = usable_samples(recording, values, window);
  EvenSeries series;
  series.interval = mean_step(recording.time, stretches,
                              kLongestStep * usual_step(recording));
  if (series.interval > 0.0) {
    Grid grid(recording.time, values, series);
    for (const auto& usable : stretches) grid.add(usable);
  }
  if (series.samples == 0)
    throw std::invalid_argument(fmt::format(
        "{}: no two powered samples in a row{}", name,
        window.from > -HUGE_VAL || window.to < HUGE_VAL
            ? fmt::format(" from {:g} to {:g} s", window.from, window.to)
            : ""));
  series.left_out = values.size() - series.samples;
  return series;
}

}  // namespace beamgyro::internal
