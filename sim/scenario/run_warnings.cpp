// SPDX-License-Identifier: MIT
#include "sim/scenario/run_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "config/units.h"
#include "sim/memory/unit_memory.h"
#include "sim/scenario/drive_lock.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {
namespace {

constexpr double kSmallestSwing = 0.05;  // [-], of the range of a profile
constexpr double kSeenShare = 0.5;       // [-], of a swing that counts as seen
constexpr double kSameFrequency = 1e-9;  // [-]

struct ProfilePoint {
  double time, value;
};

/// The points of a profile within [0, duration], with both ends.
std::vector<ProfilePoint> points_within(const PiecewiseLinear& profile,
                                        double duration) {
  std::vector<ProfilePoint> points = {{0, profile.value(0)}};
  for (std::size_t i = 0; i < profile.times().size(); ++i)
    if (profile.times()[i] > 0 && profile.times()[i] < duration)
      points.push_back({profile.times()[i], profile.values()[i]});
  points.push_back({duration, profile.value_before(duration)});
  return points;
}

/// The numbers of the points between which a profile swings by `smallest` or
/// more, the first and the last of them included.
std::vector<std::size_t> turns_of(const std::vector<ProfilePoint>& points,
                                  double smallest) {
  std::vector<std::size_t> turns;
  std::size_t low = 0, high = 0;  // since the last turn
  double direction = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double value = points[i].value;
    if (value < points[low].value) low = i;
    if (value > points[high].value) high = i;
    if (direction <= 0 && value - points[low].value >= smallest) {
      turns.push_back(low);
      direction = 1;
      high = i;
    } else if (direction >= 0 && points[high].value - value >= smallest) {
      turns.push_back(high);
      direction = -1;
      low = i;
    }
  }
  if (direction != 0) turns.push_back(direction > 0 ? high : low);
  return turns;
}

/// The sampled value next to a turn that is nearest to it: the greatest or the
/// least one from the turn before it to the turn after it. None without
/// samples.
std::optional<double> seen_extreme(const PiecewiseLinear& profile,
                                   const std::vector<ProfilePoint>& points,
                                   std::size_t first, std::size_t last,
                                   bool is_high, const SampleGrid& grid) {
  std::optional<double> seen;
  // Between points the extremes are beside the points.
  for (std::size_t i = first; i <= last; ++i) {
    const std::size_t after = grid.first_from(points[i].time);
    for (const std::size_t k : {after - (after > 0 ? 1 : 0), after}) {
      if (k >= grid.count || grid.time(k) < points[first].time ||
          grid.time(k) > points[last].time)
        continue;
      const double value = profile.value(grid.time(k));
      if (!seen || (is_high ? value > *seen : value < *seen)) seen = value;
    }
  }
  return seen;
}

/// How many swings a profile makes, and how many of them are lost.
struct SwingCount {
  std::size_t all = 0, lost = 0;
};

SwingCount swings_of(const PiecewiseLinear& profile, double duration,
                     const SampleGrid& grid) {
  const std::vector<ProfilePoint> points = points_within(profile, duration);
  const auto [least, greatest] =
      std::ranges::minmax(points, {}, &ProfilePoint::value);
  const double range = greatest.value - least.value;
  if (range == 0) return {};
  const std::vector<std::size_t> turns =
      turns_of(points, kSmallestSwing * range);
  SwingCount count;
  std::optional<double> before;
  for (std::size_t j = 0; j < turns.size(); ++j) {
    const std::size_t other = turns[j > 0 ? j - 1 : 1];
    const bool is_high = points[turns[j]].value > points[other].value;
    const std::optional<double> seen = seen_extreme(
        profile, points, j > 0 ? turns[j - 1] : 0,
        j + 1 < turns.size() ? turns[j + 1] : points.size() - 1, is_high, grid);
    if (j > 0) {
      const double swing =
          std::abs(points[turns[j]].value - points[other].value);
      const double shown =
          seen && before ? (is_high ? *seen - *before : *before - *seen) : 0;
      ++count.all;
      // A rounding below half is half.
      if (shown < (kSeenShare - 1e-9) * swing) ++count.lost;
    }
    before = seen;
  }
  return count;
}

std::string sine_text(std::string_view key, const SineSignal& sine,
                      const SampleGrid& grid) {
  const double half = grid.rate / 2;
  if (sine.amplitude == 0 || sine.frequency < half * (1 - kSameFrequency))
    return {};
  if (sine.frequency <= half * (1 + kSameFrequency))
    return fmt::format(
        "{}.sine.frequency_Hz = {:g} is half of output_rate_Hz = {:g}: "
        "the {} samples show {:.3g} % of its amplitude, by its phase",
        key, sine.frequency, grid.rate, grid.count,
        100 * std::abs(std::sin(sine.phase)));
  return fmt::format(
      "{}.sine.frequency_Hz = {:.11g} is above half of output_rate_Hz = "
      "{:.11g}: the {} samples show it as {:.4g} Hz",
      key, sine.frequency, grid.rate, grid.count,
      std::abs(sine.frequency -
               grid.rate * std::round(sine.frequency / grid.rate)));
}

std::string random_text(std::string_view key, const RandomRate& random,
                        const SampleGrid& grid) {
  if (random.bandwidth < grid.rate / 2 * (1 - kSameFrequency)) return {};
  return fmt::format(
      "{}.random.bandwidth_Hz = {:.11g} is not below half of output_rate_Hz = "
      "{:.11g}: the {} samples show what is faster as slower",
      key, random.bandwidth, grid.rate, grid.count);
}

std::string aliasing_text(std::string_view key, const RateProfile& profile,
                          const ScenarioPlan& scenario) {
  const SampleGrid grid = sample_grid(scenario);
  if (!moves(profile)) return {};
  if (const auto* sine = std::get_if<SineSignal>(&profile))
    return sine_text(key, *sine, grid);
  if (const auto* random = std::get_if<RandomRate>(&profile))
    return random_text(key, *random, grid);
  const SwingCount swings =
      swings_of(std::get<PiecewiseLinear>(profile), scenario.duration, grid);
  if (swings.lost == 0) return {};
  return fmt::format(
      "{}: {} of {} swings of the profile are lost, wholly or by more than "
      "half, between samples {:g} s apart; output_rate_Hz = {:.11g}",
      key, swings.lost, swings.all, 1 / grid.rate, grid.rate);
}

/// Returns one warning for each motion that the samples do not show:
/// - a sine of half the output rate or more;
/// - a random motion whose bandwidth is half the output rate or more;
/// - a profile with swings of which the samples show less than half. A swing
///   goes from one turn of the profile to the next; one of less than 5 % of the
///   range of the profile counts as noise.
std::vector<std::string> aliasing_warnings(const ScenarioPlan& scenario) {
  const ScenarioPlan aligned = with_aligned_borders(scenario);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < kCaseAxisCount; ++i) {
    std::string text =
        aliasing_text(kCaseAxes[i].key, aligned.motion[i], aligned);
    if (!text.empty()) texts.push_back(std::move(text));
  }
  return texts;
}

std::string soaks_text(const ScenarioPlan& scenario) {
  constexpr double kRoundoff = 1e-9;  // as for the number of samples
  const std::vector<double>& ends = scenario.soak_ends;
  const auto cut = std::ranges::count_if(ends, [&](double end) {
    return end > scenario.duration * (1 + kRoundoff);
  });
  if (cut == 0) return {};
  return fmt::format(
      "ambient.soaks: duration_s = {:.11g} cuts {} of {} soaks; the last ends "
      "at {:.11g} s",
      scenario.duration, cut, ends.size(), ends.back());
}

/// Why no sample is powered.
std::string power_cause(const ScenarioPlan& scenario) {
  const SampleGrid grid = sample_grid(scenario);
  const double last = grid.time(grid.count - 1);
  std::string before, after;
  for (const PowerInterval& powered : scenario.powered) {
    if (powered.on <= last) {
      before = powered.off <= 0
                   ? fmt::format("the power is off since power.off_s = {}",
                                 powered.off)
                   : fmt::format(
                         "the power is on at power.on_s = {} and off again at "
                         "power.off_s = {}, between samples {:g} s apart",
                         powered.on, powered.off, 1 / grid.rate);
      continue;
    }
    after =
        powered.on < scenario.duration
            ? fmt::format("power.on_s = {} is after the last sample, at {:g} s",
                          powered.on, last)
            : fmt::format("power.on_s = {} is not before duration_s = {}",
                          powered.on, scenario.duration);
    break;
  }
  return before + (before.empty() || after.empty() ? "" : ", and ") + after;
}

bool is_beyond_ceramic(double celsius) {
  constexpr double kThermalError = 1e-3;  // [K], of a run
  return celsius < kLinearCeramic.low - kThermalError ||
         celsius > kLinearCeramic.high + kThermalError;
}

std::string share(std::size_t count, std::size_t all) {
  return count == all ? fmt::format("all {}", all)
                      : fmt::format("{} of {}", count, all);
}

}  // namespace

void RunWarnings::Temperatures::add(double celsius) {
  lowest = count == 0 ? celsius : std::min(lowest, celsius);
  highest = count == 0 ? celsius : std::max(highest, celsius);
  ++count;
}

void RunWarnings::add(const Recording& block) {
  const std::vector<double>& beam =
      column_values(block, "true_beam_temperature");
  const std::vector<double>& voltage = column_values(block, "drive_voltage");
  const std::vector<double>& ambient =
      column_values(block, "true_ambient_temperature");
  const std::vector<double>& shown = column_values(block, "temperature");
  const std::vector<double>& sensor =
      column_values(block, "true_sensor_temperature");
  const std::vector<double>& rate = column_values(block, "rate");
  const double limit =
      device_.drive.voltage_limit - device_.readout.drive_voltage_resolution;
  samples_ += block.status.size();
  for (std::size_t k = 0; k < block.status.size(); ++k) {
    const std::uint8_t status = block.status[k];
    powered_ += (status & kUnpowered) == 0;
    saturated_ += (status & kOutputSaturated) != 0;
    if (is_beyond_ceramic(beam[k])) clamped_.add(beam[k]);
    if ((status & kUnpowered) == 0) {
      shown_.add(shown[k]);
      sensor_.add(sensor[k]);
      rate_.add(rate[k]);
      if (device_.thermal.oven &&
          ambient[k] + kZeroCelsius > device_.thermal.oven->set_point)
        around_oven_.add(ambient[k]);
    }
    if ((status & kLoopNotLocked) == 0) continue;
    ++unlocked_;
    limited_ += std::abs(voltage[k]) >= limit;
    if (lock_is_due(scenario_, block.time[k])) lost_.add(beam[k]);
  }
}

std::string RunWarnings::history_text() const {
  constexpr double kSame = 1e-6;  // [K]
  if (!scenario_.history) return {};
  if (!device_.memory.any())
    return "history.points changes nothing: the device has no [memory]";
  const double last = scenario_.history->values().back();
  const double first = scenario_.ambient.value(0);
  if (std::abs(first - last) <= kSame) return {};
  return fmt::format(
      "history.points ends at {:.6g} degC and the run begins at {:.6g} degC; "
      "the unit was brought there at {:g} K/min before time 0",
      last - kZeroCelsius, first - kZeroCelsius, 60 * kHandlingRate);
}

std::string RunWarnings::walk_text() const {
  const NoiseParameters& noise = device_.noise;
  const double t_c = noise.walk_correlation;
  if (!scenario_.noise_enabled || scenario_.has_age ||
      noise.rate_random_walk == 0 || scenario_.duration <= t_c)
    return {};
  const double K = noise.rate_random_walk / kDegree;
  return fmt::format(
      "the random walk of a run without age.hours has no bound: {:.2g} deg/s "
      "(1-sigma) after {:.4g} h, where noise.random_walk_correlation_h = {:g} "
      "holds that of a run with age.hours to {:.2g} deg/s",
      K * std::sqrt(scenario_.duration), scenario_.duration / 3600, t_c / 3600,
      K * std::sqrt(0.5 * t_c));
}

std::string RunWarnings::heat_text() const {
  if (clamped_.count == 0) return {};
  return fmt::format(
      "the beam is at {:.4g} to {:.4g} degC in {} samples, beyond {:g} to {:g} "
      "degC, where the ceramic's coefficients are linear; they keep the values "
      "of the nearest end",
      clamped_.lowest, clamped_.highest, share(clamped_.count, samples_),
      kLinearCeramic.low, kLinearCeramic.high);
}

std::string RunWarnings::power_text() const {
  if (powered_ > 0) return {};
  return fmt::format("all {} samples are unpowered: {}", samples_,
                     power_cause(scenario_));
}

std::string RunWarnings::saturation_text() const {
  if (powered_ == 0 || 2 * saturated_ < powered_) return {};
  return fmt::format(
      "{} powered samples are saturated; likely cause: rates and drift beyond "
      "readout.full_scale_deg_per_s = {:g}",
      share(saturated_, powered_), device_.readout.full_scale / kDegree);
}

std::string RunWarnings::lock_text() const {
  const bool is_lost = lost_.count > 0;
  if (!is_lost && (powered_ == 0 || 2 * unlocked_ < powered_)) return {};
  std::string text = fmt::format(
      "in {} powered samples the loops are not locked; likely cause: ",
      share(unlocked_, powered_));
  if (2 * limited_ >= unlocked_) {
    text +=
        fmt::format("the drive needs more than drive.voltage_limit_V = {:g}",
                    device_.drive.voltage_limit);
  } else if (is_lost) {
    text += "the drive loop does not hold amplitude and phase of this device";
  } else {
    text += fmt::format(
        "the loops lock within {:g} s of a power-on, and the run has little "
        "more",
        kLockTime);
  }
  if (!is_lost) return text;
  return text + fmt::format(" with the beam at {:.4g} to {:.4g} degC",
                            lost_.lowest, lost_.highest);
}

std::string RunWarnings::oven_text() const {
  if (around_oven_.count == 0) return {};
  return fmt::format(
      "thermal.oven.set_point_degC = {:g} is below the surroundings in {} "
      "powered samples, which are at up to {:.4g} degC; an oven heats and "
      "cannot cool",
      device_.thermal.oven->set_point - kZeroCelsius,
      share(around_oven_.count, powered_), around_oven_.highest);
}

std::string RunWarnings::coarse_rate_text() const {
  constexpr double kCoarse = 0.01;  // [-], of the full scale
  const double step = std::exp2(1.0 - device_.readout.adc_bits);
  if (powered_ < 2 || rate_.span() > 0 || step < kCoarse) return {};
  return fmt::format(
      "readout.adc_bits = {} makes steps of {:.4g} deg/s: {} powered samples "
      "show the rate {:.4g} deg/s",
      device_.readout.adc_bits, step * device_.readout.full_scale / kDegree,
      share(powered_, powered_), rate_.lowest);
}

std::string RunWarnings::coarse_temperature_text() const {
  constexpr double kMoves = 1;  // [K]
  const double step = device_.temperature_sensor.resolution;
  if (powered_ < 2 || shown_.span() > 0 || sensor_.span() < kMoves ||
      step < kMoves)
    return {};
  return fmt::format(
      "temperature_sensor.resolution_K = {:g}: {} powered samples show {:.4g} "
      "degC, while the sensor moves by {:.3g} K",
      step, share(powered_, powered_), shown_.lowest, sensor_.span());
}

std::vector<std::string> RunWarnings::texts() const {
  std::vector<std::string> texts = aliasing_warnings(scenario_);
  for (std::string text :
       {soaks_text(scenario_), history_text(), walk_text(), heat_text(),
        power_text(), saturation_text(), lock_text(), oven_text(),
        coarse_rate_text(), coarse_temperature_text()})
    if (!text.empty()) texts.push_back(std::move(text));
  return texts;
}

}  // namespace beamgyro::internal
