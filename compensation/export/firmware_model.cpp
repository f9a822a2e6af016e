// SPDX-License-Identifier: MIT
#include "compensation/export/firmware_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace beamgyro {
namespace {

#include "compensation/export/firmware_runtime.c99"

const char* const kRuntime =
#include "compensation/export/firmware_runtime_text.h"
    ;

float single(double value) {
  const auto result = static_cast<float>(value);
  if (!std::isfinite(result))
    throw std::invalid_argument(
        fmt::format("the parameter {} does not fit single precision", value));
  return result;
}

template <class Numbers>
std::vector<float> singles(const Numbers& numbers) {
  std::vector<float> result;
  for (const double number : numbers) result.push_back(single(number));
  return result;
}

// Layers of a network as rows: weights of a neuron after one another.
struct LayerArrays {
  std::vector<float> weights, biases;
};

std::vector<LayerArrays> layer_arrays(const BpNetwork& network) {
  const std::vector<int>& sizes = network.layer_sizes();
  const std::vector<float> flat = singles(network.weights());
  std::vector<LayerArrays> result;
  std::size_t offset = 0;
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const auto in = static_cast<std::size_t>(sizes[k - 1]);
    const auto out = static_cast<std::size_t>(sizes[k]);
    LayerArrays& layer = result.emplace_back();
    for (std::size_t o = 0; o < out; ++o)
      for (std::size_t i = 0; i < in; ++i)
        layer.weights.push_back(flat[offset + i * out + o]);
    for (std::size_t o = 0; o < out; ++o)
      layer.biases.push_back(flat[offset + in * out + o]);
    offset += (in + 1) * out;
  }
  return result;
}

// The constants of each kind of model.
struct KindArrays {
  std::vector<FirmwareArray>& arrays;

  void operator()(const NoBias&) const {}
  void operator()(const ConstantBias& constant) const {
    arrays.push_back({"constant", "[deg/s]", {single(constant.value)}});
  }
  void operator()(const Polynomial& p) const {
    arrays.push_back({"coefficients", "of the powers 0, 1, ... of x[0]",
                      singles(p.coefficients)});
    if (!p.slopes.empty())
      arrays.push_back({"slopes", "of x[1], ...", singles(p.slopes)});
  }
  void operator()(const LookupTable& table) const {
    arrays.push_back({"temperatures", "[degC]", singles(table.temperatures)});
    arrays.push_back({"values", "[deg/s]", singles(table.values)});
  }
  void operator()(const CubicSpline& spline) const {
    arrays.push_back({"knots", "[degC]", singles(spline.knots)});
    arrays.push_back({"values", "[deg/s]", singles(spline.values)});
    arrays.push_back({"seconds", "second derivatives [deg/s/K^2]",
                      singles(spline.second_derivatives)});
  }
  void operator()(const ThermistorNetwork& n) const {
    arrays.push_back({"network", "B [K], r_s, r_p, r_d, offset, gain [deg/s]",
                      singles(std::vector{n.b_K, n.series, n.parallel,
                                          n.divider, n.offset, n.gain})});
  }
  void operator()(const TakagiSugeno& fuzzy) const {
    arrays.push_back({"centres", "of x[0]", singles(fuzzy.centres)});
    arrays.push_back({"width", "", {single(fuzzy.width)}});
    const Eigen::MatrixXd rows = fuzzy.consequents.transpose();
    arrays.push_back(
        {"rules", "constant and slopes of each", singles(rows.reshaped())});
  }
  void operator()(const BpNetwork& network) const {
    int number = 0;
    for (const LayerArrays& layer : layer_arrays(network)) {
      ++number;
      arrays.push_back({fmt::format("weights_{}", number),
                        "of each neuron after one another", layer.weights});
      arrays.push_back(
          {fmt::format("biases_{}", number), "of the neurons", layer.biases});
    }
  }
};

int drive_frequency_of(const Compensator& c) {
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

std::vector<FirmwareArray> arrays_of(const Compensator& c) {
  std::vector<double> centres, gains, constants;
  for (std::size_t i = 0; i < c.inputs.size(); ++i) {
    const bool frequency =
        c.inputs[i].column == kFirmwareSignals[kFirmwareDriveFrequency];
    centres.push_back(c.bias.input_scales[i].centre -
                      (frequency ? drive_frequency_of(c) : 0));
    gains.push_back(1.0 / c.bias.input_scales[i].half_width);
    constants.push_back(c.inputs[i].time_constant);
  }
  std::vector<FirmwareArray> arrays = {
      {"range", "of the temperature [degC]",
       singles(std::vector{c.temperature_range.lowest,
                           c.temperature_range.highest})},
      {"centres_of_inputs", "", singles(centres)},
      {"gains_of_inputs", "x = (input - centre) gain", singles(gains)},
      {"time_constants", "[s], 0 where there is none", singles(constants)},
      {"unit", "bias = unit[0] + unit[1] f(x) [deg/s]",
       singles(std::vector{c.bias.bias_scale.centre,
                           c.bias.bias_scale.half_width})}};
  std::visit(KindArrays{arrays}, c.bias.function);
  if (c.scale_factor) {
    arrays.push_back({"scale_factor_temperatures", "[degC]",
                      singles(c.scale_factor->temperatures)});
    arrays.push_back({"scale_factors", "over the nominal one",
                      singles(c.scale_factor->values)});
  }
  return arrays;
}

std::size_t signal_of(const Input& input) {
  return static_cast<std::size_t>(std::find(std::begin(kFirmwareSignals),
                                            std::end(kFirmwareSignals),
                                            input.column) -
                                  std::begin(kFirmwareSignals));
}

int count_of(const std::vector<float>& values) {
  return static_cast<int>(values.size());
}

}  // namespace

std::uint32_t crc32(const std::vector<float>& values) {
  return ~crc_of(0xffffffffu, values.data(), count_of(values));
}

struct FirmwareModel::State {
  float period = 0.0f;
  std::uint32_t samples = 0;
  bool started = false;                       // since the first temperature
  std::vector<std::array<float, 5>> filters;  // one per input
};

FirmwareModel::FirmwareModel(const Compensator& c)
    : inputs_(c.inputs),
      kind_(kind_name(c.bias)),
      corrects_scale_factor_(c.scale_factor.has_value()),
      drive_frequency_(drive_frequency_of(c)),
      arrays_(arrays_of(c)),
      state_(std::make_unique<State>()) {
  if (const auto* network = std::get_if<BpNetwork>(&c.bias.function))
    layers_ = network->layer_sizes();
}

FirmwareModel::~FirmwareModel() = default;

const std::vector<float>& FirmwareModel::array(std::string_view name) const {
  return std::find_if(
             arrays_.begin(), arrays_.end(),
             [&](const FirmwareArray& array) { return array.name == name; })
      ->values;
}

bool FirmwareModel::reads(std::size_t signal) const {
  if (signal < 2) return true;  // rate and temperature
  return std::any_of(inputs_.begin(), inputs_.end(), [&](const Input& input) {
    return input.column == kFirmwareSignals[signal];
  });
}

std::uint32_t FirmwareModel::crc() const {
  std::vector<float> all;
  for (const FirmwareArray& array : arrays_)
    all.insert(all.end(), array.values.begin(), array.values.end());
  return crc32(all);
}

void FirmwareModel::start(float period) {
  state_->period = period;
  state_->samples = 0;
  state_->started = false;
  state_->filters.assign(inputs_.size(), {});
  const std::vector<float>& constants = array("time_constants");
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (constants[i] > 0.0f)
      start_lowpass(state_->filters[i].data(), period, constants[i]);
}

float FirmwareModel::step(const FirmwareSample& sample) {
  const std::vector<float>& range = array("range");
  const std::vector<float>& centres = array("centres_of_inputs");
  const std::vector<float>& gains = array("gains_of_inputs");
  const std::vector<float>& constants = array("time_constants");
  const std::uint32_t samples = state_->samples;
  if (state_->samples < 0xffffffffu) ++state_->samples;
  float T = sample.value[1];
  if (is_finite(T) == 0) return T - T;
  if (T < range[0]) T = range[0];
  if (T > range[1]) T = range[1];
  const int first = state_->started ? 0 : 1;
  state_->started = true;
  std::vector<float> x(inputs_.size());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Input& input = inputs_[i];
    float value = T;
    if (input.kind == InputKind::kColumn && input.column != "temperature")
      value = sample.value[signal_of(input)];
    if (input.kind == InputKind::kSincePowerOn)
      value = exp_minus(static_cast<float>(samples) * state_->period /
                        constants[i]);
    if (input.kind == InputKind::kTemperatureLowpass)
      value = T - lowpass_lag(state_->filters[i].data(), first, T);
    if (input.kind == InputKind::kTemperatureRate)
      value = lowpass_lag(state_->filters[i].data(), first, T) / constants[i];
    x[i] = (value - centres[i]) * gains[i];
  }
  if (kind_ != "none" && kind_ != "constant")  // which read no input
    for (const float value : x)
      if (is_finite(value) == 0) return value - value;
  const std::vector<float>& unit = array("unit");
  float rate = sample.value[0] - (unit[0] + unit[1] * bias(x));
  if (corrects_scale_factor_)
    rate = rate / table_at(array("scale_factor_temperatures").data(),
                           array("scale_factors").data(),
                           count_of(array("scale_factors")), T);
  return rate;
}

float FirmwareModel::bias(const std::vector<float>& x) const {
  const auto data = [&](const char* name) { return array(name).data(); };
  const auto count = [&](const char* name) { return count_of(array(name)); };
  if (kind_ == "none") return 0.0f;
  if (kind_ == "constant") return array("constant")[0];
  if (kind_ == "table")
    return table_at(data("temperatures"), data("values"), count("values"),
                    x[0]);
  if (kind_ == "spline")
    return spline_at(data("knots"), data("values"), data("seconds"),
                     count("values"), x[0]);
  if (kind_ == "thermistor") return thermistor_at(data("network"), x[0]);
  if (kind_ == "fuzzy")
    return fuzzy_of(data("centres"), array("width")[0], data("rules"),
                    count("centres"), count_of(x), x.data());
  if (kind_ == "polynomial") {
    float y = polynomial_of(data("coefficients"), count("coefficients"), x[0]);
    for (std::size_t j = 1; j < x.size(); ++j)
      y = y + array("slopes")[j - 1] * x[j];
    return y;
  }
  std::vector<float> a = x;
  for (std::size_t k = 1; k < layers_.size(); ++k) {
    const std::vector<float>& w = array(fmt::format("weights_{}", k));
    std::vector<float> z = array(fmt::format("biases_{}", k));
    for (std::size_t o = 0; o < z.size(); ++o) {
      for (std::size_t i = 0; i < a.size(); ++i)
        z[o] = z[o] + w[o * a.size() + i] * a[i];
      if (k + 1 < layers_.size()) z[o] = tanh_of(z[o]);
    }
    a = std::move(z);
  }
  return a[0];
}

std::string firmware_runtime(std::string_view section) {
  const std::string_view text = kRuntime;
  const std::string mark = fmt::format("/* @section {} */\n", section);
  const std::size_t begin = text.find(mark);
  if (begin == std::string_view::npos)
    throw std::logic_error(
        fmt::format("no section {} of the run-time", section));
  const std::size_t from = begin + mark.size();
  return std::string(text.substr(from, text.find("/* @section", from) - from));
}

}  // namespace beamgyro
