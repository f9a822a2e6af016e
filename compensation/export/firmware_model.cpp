// SPDX-License-Identifier: MIT
#include "compensation/export/firmware_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "compensation/firmware/runtime.h"

namespace beamgyro::internal {
namespace {

int drive_frequency_of(const FittedCompensator& c) {
  for (std::size_t i = 0; i < c.inputs.size(); ++i)
    if (c.inputs[i].column == kFirmwareSignals[kFirmwareDriveFrequency]) {
      const double centre = c.bias.input_scales[i].centre;
      if (!(std::abs(centre) < 1e9))
        throw std::invalid_argument(
            fmt::format("the drive frequency {} Hz is beyond 1e9 Hz", centre));
      return static_cast<int>(std::lround(centre));
    }
  return 0;
}

// Each amplitude times the factor.
void put_sigma_arrays(const BiasSigma& sigma, FirmwareArrays& arrays) {
  const SigmaTerm none{0.0, kSigmaTimeConstant};
  const SigmaTerm on = sigma.power_on.value_or(none);
  const SigmaTerm rate = sigma.temperature_rate.value_or(none);
  const double k = sigma.factor;
  arrays.add(
      {"sigma_temperatures", "[degC]", singles(sigma.curve.temperatures)});
  arrays.add({"sigmas", "[deg/s]", singles(k * sigma.curve.values)});
  arrays.add({"sigma_growth", "below and above them [deg/s/K]",
              singles(std::vector{k * sigma.growth[0], k * sigma.growth[1]})});
  arrays.add({"sigma_terms",
              "of power-on [deg/s], [s], of temperature rate [deg/s/(K/s)], "
              "[s]",
              singles(std::vector{k * on.amplitude, on.time_constant,
                                  k * rate.amplitude, rate.time_constant})});
}

FirmwareArrays arrays_of(const FittedCompensator& c) {
  std::vector<double> centres, gains, constants, half_widths;
  bool plays = false;
  for (std::size_t i = 0; i < c.inputs.size(); ++i) {
    const bool frequency =
        c.inputs[i].column == kFirmwareSignals[kFirmwareDriveFrequency];
    centres.push_back(c.bias.input_scales[i].centre -
                      (frequency ? drive_frequency_of(c) : 0));
    gains.push_back(1.0 / c.bias.input_scales[i].half_width);
    const bool play = c.inputs[i].kind == InputKind::kTemperaturePlay;
    plays = plays || play;
    constants.push_back(play ? 0 : c.inputs[i].parameter);
    half_widths.push_back(play ? c.inputs[i].parameter : 0);
  }
  FirmwareArrays arrays;
  arrays.add({"range", "of the temperature [degC]",
              singles(std::vector{c.temperature_range.lowest,
                                  c.temperature_range.highest})});
  arrays.add({"centres_of_inputs", "", singles(centres)});
  arrays.add({"gains_of_inputs", "x = (input - centre) gain", singles(gains)});
  arrays.add(
      {"time_constants", "[s], 0 where there is none", singles(constants)});
  if (plays)
    arrays.add(
        {"half_widths", "[K], 0 where there is none", singles(half_widths)});
  arrays.add({"unit", "bias = unit[0] + unit[1] f(x) [deg/s]",
              singles(std::vector{c.bias.bias_scale.centre,
                                  c.bias.bias_scale.half_width})});
  std::visit([&](const auto& f) { f.put_arrays(arrays); }, c.bias.function);
  if (c.scale_factor) {
    arrays.add({"scale_factor_temperatures", "[degC]",
                singles(c.scale_factor->temperatures)});
    arrays.add({"scale_factors", "over the nominal one",
                singles(c.scale_factor->values)});
  }
  if (c.sigma) put_sigma_arrays(*c.sigma, arrays);
  return arrays;
}

std::size_t signal_of(const Input& input) {
  return static_cast<std::size_t>(std::find(std::begin(kFirmwareSignals),
                                            std::end(kFirmwareSignals),
                                            input.column) -
                                  std::begin(kFirmwareSignals));
}

// Of scaled inputs; 0, or the constant, where it reads none.
float bias_of(const BiasFunction& function, const FirmwareArrays& arrays,
              std::span<const float> x) {
  return std::visit(
      [&]<class Function>(const Function& f) {
        if constexpr (std::is_same_v<Function, NoBias>)
          return 0.0f;
        else if constexpr (std::is_same_v<Function, ConstantBias>)
          return arrays.values("constant")[0];
        else
          return f.firmware_value(arrays, x);
      },
      function);
}

}  // namespace

std::uint32_t crc32(const std::vector<float>& values) {
  return ~runtime::crc_of(0xffffffffu, values.data(),
                          static_cast<int>(values.size()));
}

FirmwareModel::FirmwareModel(const FittedCompensator& c)
    : inputs_(c.inputs),
      function_(c.bias.function),
      uses_inputs_(reads_inputs(c.bias)),
      corrects_scale_factor_(c.scale_factor.has_value()),
      states_sigma_(c.sigma.has_value()),
      drive_frequency_(drive_frequency_of(c)),
      arrays_(arrays_of(c)) {}

bool FirmwareModel::reads(std::size_t signal) const {
  if (signal < 2) return true;  // rate and temperature
  return std::any_of(inputs_.begin(), inputs_.end(), [&](const Input& input) {
    return input.column == kFirmwareSignals[signal];
  });
}

std::uint32_t FirmwareModel::crc() const {
  std::vector<float> all;
  for (const FirmwareArray& array : arrays_.all())
    all.insert(all.end(), array.values.begin(), array.values.end());
  return crc32(all);
}

void FirmwareModel::start(float period) {
  state_ = {.period = period,
            .filters = std::vector<std::array<float, 5>>(inputs_.size()),
            .plays = std::vector<float>(inputs_.size()),
            .sigma = state_.sigma};
  const std::vector<float>& constants = arrays_.values("time_constants");
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (constants[i] > 0.0f)
      runtime::start_lowpass(state_.filters[i].data(), period, constants[i]);
  if (states_sigma_)
    runtime::start_lowpass(state_.sigma_filter.data(), period,
                           arrays_.values("sigma_terms")[3]);
}

float FirmwareModel::sigma() const { return state_.sigma; }

float FirmwareModel::scale_factor_at(float temperature) const {
  return runtime::table_at(arrays_.data("scale_factor_temperatures"),
                           arrays_.data("scale_factors"),
                           arrays_.count("scale_factors"), temperature);
}

// Before step() has counted the sample.
float FirmwareModel::next_sigma(float temperature) {
  if (runtime::is_finite(temperature) == 0) return temperature - temperature;
  temperature =
      std::clamp(temperature, static_cast<float>(kSigmaTemperatures.lowest),
                 static_cast<float>(kSigmaTemperatures.highest));
  const float* terms = arrays_.data("sigma_terms");
  const float since = static_cast<float>(state_.samples) * state_.period;
  const float on = terms[0] * runtime::exp_minus(since / terms[1]);
  const float lag = runtime::lowpass_lag(
      state_.sigma_filter.data(), state_.sigma_started ? 0 : 1, temperature);
  state_.sigma_started = true;
  const float sigma = runtime::sigma_at(
      arrays_.data("sigma_temperatures"), arrays_.data("sigmas"),
      arrays_.count("sigmas"), arrays_.data("sigma_growth"), temperature, on,
      terms[2] * (lag / terms[3]));
  if (!corrects_scale_factor_) return sigma;
  const float* range = arrays_.data("range");
  const float clamped = std::min(std::max(temperature, range[0]), range[1]);
  return sigma / scale_factor_at(clamped);
}

float FirmwareModel::step(const FirmwareSample& sample) {
  const std::vector<float>& range = arrays_.values("range");
  const std::vector<float>& centres = arrays_.values("centres_of_inputs");
  const std::vector<float>& gains = arrays_.values("gains_of_inputs");
  const std::vector<float>& constants = arrays_.values("time_constants");
  if (states_sigma_) state_.sigma = next_sigma(sample.value[1]);
  const std::uint32_t samples = state_.samples;
  if (state_.samples < 0xffffffffu) ++state_.samples;
  float T = sample.value[1];
  if (runtime::is_finite(T) == 0) return T - T;
  if (T < range[0]) T = range[0];
  if (T > range[1]) T = range[1];
  for (const Input& input : inputs_)
    if (uses_inputs_ && filters_a_signal(input))
      if (const float value = sample.value[signal_of(input)];
          runtime::is_finite(value) == 0)
        return value - value;
  const int first = state_.started ? 0 : 1;
  state_.started = true;
  std::vector<float> x(inputs_.size());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Input& input = inputs_[i];
    float value = reads_a_signal(input) ? sample.value[signal_of(input)] : T;
    if (input.kind == InputKind::kSincePowerOn)
      value = runtime::exp_minus(static_cast<float>(samples) * state_.period /
                                 constants[i]);
    if (input.kind == InputKind::kLowpass)
      value =
          value - runtime::lowpass_lag(state_.filters[i].data(), first, value);
    if (input.kind == InputKind::kTemperatureRate)
      value = runtime::lowpass_lag(state_.filters[i].data(), first, T) /
              constants[i];
    if (input.kind == InputKind::kTemperaturePlay)
      value = runtime::play_at(&state_.plays[i], first, T,
                               arrays_.values("half_widths")[i]);
    x[i] = (value - centres[i]) * gains[i];
  }
  if (uses_inputs_)
    for (const float value : x)
      if (runtime::is_finite(value) == 0) return value - value;
  const std::vector<float>& unit = arrays_.values("unit");
  float rate =
      sample.value[0] - (unit[0] + unit[1] * bias_of(function_, arrays_, x));
  if (corrects_scale_factor_) rate = rate / scale_factor_at(T);
  return rate;
}

}  // namespace beamgyro::internal
