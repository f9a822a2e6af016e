// SPDX-License-Identifier: MIT
#include "compensation/inputs/features.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace beamgyro::internal {
namespace {

const std::vector<double>& input_column(const Input& input,
                                        const Recording& recording) {
  const Column* column = find_column(recording, input.column);
  if (column != nullptr && column->role == Role::kMeasured)
    return column->values;
  std::vector<std::string> measured;
  for (const Column& candidate : recording.columns)
    if (candidate.role == Role::kMeasured) measured.push_back(candidate.name);
  throw std::invalid_argument(fmt::format(
      "input \"{}\" needs the measured column \"{}\"; the recording has {}",
      input_name(input), input.column, fmt::join(measured, ", ")));
}

}  // namespace

double LowPass::step(double time, double x) {
  if (started_) {
    const double h = (time - time_) / time_constant_;
    lag_ = std::exp(-h) * lag_ + (x - x_) * (-std::expm1(-h) / h);
  } else {
    started_ = true;
    lag_ = 0.0;
  }
  time_ = time;
  x_ = x;
  return x - lag_;
}

double Play::step(double x) {
  p_ = started_ ? std::clamp(p_, x - half_width_, x + half_width_) : x;
  started_ = true;
  return p_;
}

FeatureStream::FeatureStream(std::vector<Input> inputs,
                             const TemperatureRange& range)
    : inputs_(std::move(inputs)), range_(range) {
  for (const Input& input : inputs_) {
    low_passes_.emplace_back(input.parameter);
    plays_.emplace_back(input.parameter);
  }
}

bool FeatureStream::step(double time, std::uint8_t status,
                         std::span<const double> measured,
                         std::span<double> features) {
  if ((status & kUnpowered) != 0) {
    powered_ = false;
    return false;
  }
  if (!powered_) {
    powered_ = true;
    power_on_time_ = time;
    for (LowPass& low_pass : low_passes_) low_pass.reset();
    for (Play& play : plays_) play.reset();
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Input& input = inputs_[i];
    if (input.kind == InputKind::kSincePowerOn) {
      features[i] = std::exp(-(time - power_on_time_) / input.parameter);
      continue;
    }
    double value = measured[i];
    if (!std::isfinite(value))
      throw std::invalid_argument(fmt::format(
          "{} is {} at t = {} s though the gyro is powered; powered samples "
          "must be finite",
          input.column, value, time));
    if (input.column == "temperature")
      value = std::clamp(value, range_.lowest, range_.highest);
    features[i] = value;
    if (input.kind == InputKind::kColumn) continue;
    if (input.kind == InputKind::kTemperaturePlay) {
      features[i] = plays_[i].step(value);
      continue;
    }
    const double smooth = low_passes_[i].step(time, value);
    features[i] = input.kind == InputKind::kTemperatureRate
                      ? (value - smooth) / input.parameter
                      : smooth;
  }
  return true;
}

Eigen::ArrayXXd features_of(const std::vector<Input>& inputs,
                            const Recording& recording,
                            const TemperatureRange& range) {
  std::vector<const double*> columns;
  columns.reserve(inputs.size());
  for (const Input& input : inputs)
    columns.push_back(
        input.column.empty() ? nullptr : input_column(input, recording).data());
  const std::size_t samples = recording.time.size(), width = inputs.size();
  Eigen::ArrayXXd result = Eigen::ArrayXXd::Constant(
      static_cast<Eigen::Index>(samples), static_cast<Eigen::Index>(width),
      std::numeric_limits<double>::quiet_NaN());
  FeatureStream stream(inputs, range);
  std::vector<double> measured(width), features(width);
  for (std::size_t k = 0; k < samples; ++k) {
    for (std::size_t i = 0; i < width; ++i)
      measured[i] = columns[i] == nullptr ? 0.0 : columns[i][k];
    if (!stream.step(recording.time[k], recording.status[k], measured,
                     features))
      continue;
    for (std::size_t i = 0; i < width; ++i)
      result(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          features[i];
  }
  return result;
}

}  // namespace beamgyro::internal
