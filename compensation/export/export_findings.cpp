// SPDX-License-Identifier: MIT
#include "compensation/export/export_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "compensation/export/firmware_model.h"
#include "compensation/scoring/scale_factor.h"
#include "compensation/training/cautions.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kSamples = 20000, kCycles = 8;
constexpr double kFastestRamp = 10.0 / 60.0;  // [K/s]
constexpr double kShareOfRamp[] = {1.0, 0.3, 0.1, 0.03};
constexpr double kDither = 0.02;  // [K], as noise of a sensor
constexpr double kRate = 150.0;   // [deg/s]
constexpr double kGolden = 0.6180339887498949;
constexpr std::size_t kTemperature = 1;  // of kFirmwareSignals

double fraction_of(double x) { return x - std::floor(x); }

// Evenly spread over -1 ... 1 in the long run, another sequence for each
// signal.
double spread(std::size_t k, std::size_t signal) {
  constexpr double kSteps[kFirmwareSignalCount] = {
      0.41421356, 0.73205081, 0.23606798, 0.64575131, 0.31662479, 0.60555128};
  return 2.0 * fraction_of(static_cast<double>(k) * kSteps[signal]) - 1.0;
}

// Returns the fastest change of temperature in training [K/s].
double fastest_ramp(const FittedCompensator& c) {
  double fastest = 0.0;
  for (std::size_t i = 0; i < c.inputs.size(); ++i)
    if (const Scale& scale = c.bias.input_scales[i];
        c.inputs[i].kind == InputKind::kTemperatureRate && scale != Scale{})
      fastest = std::max(fastest, std::abs(scale.centre) + scale.half_width);
  return fastest > 0.0 ? fastest : kFastestRamp;
}

// The part of a power cycle of `kSamples / kCycles` samples, the first of which
// has no power.
struct Place {
  std::size_t cycle, sample;

  explicit Place(std::size_t k)
      : cycle(k / (kSamples / kCycles)), sample(k % (kSamples / kCycles)) {}
};

std::vector<double> temperatures(const FittedCompensator& c, double period) {
  const double low = c.temperature_range.lowest;
  const double span = c.temperature_range.highest - low;
  const double ramp = fastest_ramp(c);
  std::vector<double> result(kSamples);
  for (std::size_t k = 0; k < kSamples; ++k) {
    const Place place(k);
    const double way = ramp * kShareOfRamp[place.cycle % 4] * period *
                       static_cast<double>(place.sample);
    const double start =
        2.0 * span * fraction_of(kGolden * static_cast<double>(place.cycle));
    // 0 ... span and back over a way of 2 span
    const double there =
        span > 0.0 ? span - std::abs(std::fmod(start + way, 2.0 * span) - span)
                   : 0.0;
    const double noise = place.cycle % 2 == 0 ? 0.0 : kDither;
    result[k] = std::clamp(low + there + noise * spread(k, kTemperature), low,
                           low + span);
  }
  return result;
}

// Returns the range of a signal: that of its input, if there is one.
Scale signal_range(const FittedCompensator& c, std::size_t signal) {
  if (!reads_inputs(c.bias)) return {0.0, kRate};
  for (std::size_t i = 0; i < c.inputs.size(); ++i)
    if (c.inputs[i].column == kFirmwareSignals[signal]) {
      const Scale& scale = c.bias.input_scales[i];
      if (scale == Scale{})
        throw std::invalid_argument(
            fmt::format("the file does not have the range of {} in training, "
                        "so the accuracy of exported code cannot be measured; "
                        "a model with normalised = true has it",
                        kFirmwareSignals[signal]));
      return scale;
    }
  return {0.0, kRate};
}

Recording samples_at(const FittedCompensator& c, const FirmwareModel& model,
                     double period) {
  Recording recording;
  for (std::size_t k = 0; k < kSamples; ++k) {
    recording.time.push_back(period * static_cast<double>(k));
    recording.status.push_back(Place(k).sample == 0 ? kUnpowered : 0);
  }
  for (std::size_t s = 0; s < kFirmwareSignalCount; ++s) {
    if (!model.reads(s)) continue;
    Column column{kFirmwareSignals[s], "", "", Role::kMeasured, {}};
    if (s == kTemperature) {
      column.values = temperatures(c, period);
    } else {
      const Scale range = signal_range(c, s);
      for (std::size_t k = 0; k < kSamples; ++k)
        column.values.push_back(range.centre + range.half_width * spread(k, s));
    }
    recording.columns.push_back(std::move(column));
  }
  return recording;
}

FirmwareDifference difference_at(const FittedCompensator& c,
                                 FirmwareModel& model, float period) {
  const Recording recording = samples_at(c, model, static_cast<double>(period));
  const std::vector<double> expected = compensated_rate(c, recording);
  const std::vector<double> sigma = compensated_rate_sigma(c, recording);
  std::array<const double*, kFirmwareSignalCount> values{};
  for (std::size_t s = 0; s < kFirmwareSignalCount; ++s)
    if (model.reads(s))
      values[s] = column_values(recording, kFirmwareSignals[s]).data();
  FirmwareDifference largest;
  for (std::size_t k = 0; k < kSamples; ++k) {
    if (recording.status[k] != 0) {
      model.start(period);
      continue;
    }
    FirmwareSample sample;
    for (std::size_t s = 0; s < kFirmwareSignalCount; ++s)
      if (values[s] != nullptr)
        sample.value[s] = static_cast<float>(
            values[s][k] -
            (s == kFirmwareDriveFrequency ? model.drive_frequency() : 0));
    const double difference = std::abs(model.step(sample) - expected[k]);
    if (!std::isfinite(difference))
      throw std::invalid_argument(fmt::format(
          "the bias is not finite in single precision, at {} degC for one",
          sample.value[kTemperature]));
    largest.rate = std::max(largest.rate, difference);
    if (sigma.empty()) continue;
    const double of_sigma =
        std::abs(static_cast<double>(model.sigma()) - sigma[k]);
    if (!std::isfinite(of_sigma))
      throw std::invalid_argument(fmt::format(
          "the sigma is not finite in single precision, at {} degC for one",
          sample.value[kTemperature]));
    largest.sigma = std::max(largest.sigma, of_sigma);
  }
  return largest;
}

}  // namespace

FirmwareDifference firmware_difference(const FittedCompensator& compensator) {
  FirmwareModel model(compensator);
  FirmwareDifference largest;
  for (const float period : kComparedPeriods) {
    const FirmwareDifference found = difference_at(compensator, model, period);
    largest = {std::max(largest.rate, found.rate),
               std::max(largest.sigma, found.sigma)};
  }
  return largest;
}

ExportFindings findings_of(const FittedCompensator& compensator) {
  ExportFindings found;
  found.difference = firmware_difference(compensator);
  const std::optional<double> kept = rate_kept(compensator);
  if (kept && !(*kept >= kCancelledBelow))
    found.objections.push_back(fmt::format(
        "it cancels the rate: of a small rate it lets {:.4f} through, and "
        "{:g} is the least",
        *kept, kCancelledBelow));
  if (!(found.difference.rate <= kLargestDifference))
    found.objections.push_back(fmt::format(
        "its answers in single precision differ by up to {:.2g} deg/s from "
        "those of compensate, and {:g} deg/s is the most; large terms that "
        "cancel lose digits, and weight_decay keeps those of a network small",
        found.difference.rate, kLargestDifference));
  if (!(found.difference.sigma <= kLargestDifference))
    found.objections.push_back(fmt::format(
        "its sigma in single precision differs by up to {:.2g} deg/s from that "
        "of compensate, and {:g} deg/s is the most",
        found.difference.sigma, kLargestDifference));
  return found;
}

}  // namespace beamgyro::internal
