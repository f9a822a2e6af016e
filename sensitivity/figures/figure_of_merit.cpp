// SPDX-License-Identifier: MIT
#include "sensitivity/figures/figure_of_merit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "compensation/models/polynomial.h"
#include "config/units.h"
#include "dataset/recording/recording.h"
#include "dataset/recording/signals.h"
#include "sim/device/modal_model.h"
#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_ode.h"

namespace beamgyro::internal {
namespace {

double bias_at(const TrimmedGyro& gyro, double beam, double board) {
  return electronics_at(gyro, board)
             .output(beam_signal(gyro, beam, {}).demodulated)
             .rate /
         kDegree;
}

NodeVector settled_temperatures(const TrimmedGyro& gyro, double ambient) {
  const ThermalNetwork network(gyro.device.thermal);
  const DriveHeating heating = drive_heating(gyro);
  const NodeVector power =
      network.powered_heating(heating.mechanical, heating.dielectric);
  const ThermalSurroundings surroundings{ambient, false};
  const auto& oven = gyro.device.thermal.oven;
  return oven ? oven_steady_state(network, *oven, power, surroundings)
                    .temperature
              : network.steady_state(power, surroundings);
}

// Long for every filter and warm-up.
constexpr double kSettled = 1e7;  // [s]
// Each temperature has a sample without power, which starts the filters anew,
// one at power-on, and one long after.
constexpr Eigen::Index kSamples = 3;

std::vector<double> held(const Eigen::ArrayXd& values) {
  std::vector<double> samples;
  for (const double value : values)
    samples.insert(samples.end(), kSamples, value);
  return samples;
}

Recording settled_recording(const DeviceParameters& device,
                            const StaticCurve& curve) {
  Recording recording;
  for (Eigen::Index k = 0; k < curve.temperature.size(); ++k) {
    const double start = 2 * kSettled * static_cast<double>(k);
    recording.time.insert(recording.time.end(),
                          {start, start + 1, start + kSettled});
    recording.status.insert(recording.status.end(), {kUnpowered, 0, 0});
  }
  const ReadoutParameters& readout = device.readout;
  const auto add = [&](const char* name, const Eigen::ArrayXd& values) {
    recording.columns.push_back(column_of(name, held(values)));
  };
  add("output", curve.bias * (readout.scale_factor * kDegree) + readout.offset);
  add("rate", curve.bias);
  add("temperature", curve.temperature + device.temperature_sensor.offset);
  add("drive_frequency", curve.drive_frequency);
  add("drive_voltage", curve.drive_voltage);
  add("quadrature", curve.quadrature);
  return recording;
}

constexpr std::array kFigures = {
    FigureOfMerit{Merit::kBiasPeakToPeak, "bias_pp_deg_per_s", "deg/s",
                  "peak to peak of the bias over the range", true},
    FigureOfMerit{Merit::kCubicRms, "cubic_rms_deg_per_s", "deg/s",
                  "rms that a cubic fitted to the bias leaves over the range",
                  true},
    FigureOfMerit{Merit::kScaleFactorDrift, "scale_factor_drift_rel", "1",
                  "peak to peak of the relative scale factor over the range",
                  true},
    FigureOfMerit{Merit::kWarmUpChange, "warm_up_change_deg_per_s", "deg/s",
                  "bias of the settled gyro less that at power-on, at 25 degC",
                  false},
    FigureOfMerit{Merit::kQuadrature, "quadrature_deg_per_s", "deg/s",
                  "largest magnitude of the quadrature over the range", true},
    FigureOfMerit{Merit::kCompensatorRms, "compensator_rms_deg_per_s", "deg/s",
                  "rms that the compensator leaves over the range", true},
};

double root_mean_square(const Eigen::ArrayXd& values) {
  return std::sqrt(values.square().mean());
}

double peak_to_peak(const Eigen::ArrayXd& values) {
  return values.maxCoeff() - values.minCoeff();
}

// In the middle of the range the powers stay near 1.
double left_by_cubic(const StaticCurve& curve) {
  const double low = curve.temperature.minCoeff();
  const double half = 0.5 * (curve.temperature.maxCoeff() - low);
  const Eigen::ArrayXXd x = (curve.temperature - low) / half - 1;
  return root_mean_square(curve.bias -
                          fit_polynomial(x, curve.bias, 3).predict(x));
}

/// The figures of one device; the curve is computed once, when one needs it.
class MeritsOf {
 public:
  MeritsOf(const DeviceParameters& device, const MeritOptions& options)
      : gyro_(make_gyro(device)), options_(options) {}

  double operator()(Merit merit) {
    switch (merit) {
      case Merit::kBiasPeakToPeak:
        return peak_to_peak(curve().bias);
      case Merit::kCubicRms:
        return left_by_cubic(curve());
      case Merit::kScaleFactorDrift:
        return peak_to_peak(scale_factor_curve(gyro_, options_.grid));
      case Merit::kWarmUpChange:
        return warm_up_change(gyro_, options_.ambient);
      case Merit::kQuadrature:
        return curve().quadrature.abs().maxCoeff();
      case Merit::kCompensatorRms:
        return root_mean_square(
            settled_residual(*options_.compensator, gyro_.device, curve()));
    }
    return 0;
  }

  // None where no figure needs the curve.
  const std::optional<StaticCurve>& known_curve() const { return curve_; }

 private:
  const StaticCurve& curve() {
    if (!curve_) curve_ = static_curve(gyro_, options_.grid);
    return *curve_;
  }

  TrimmedGyro gyro_;
  const MeritOptions& options_;
  std::optional<StaticCurve> curve_;
};

}  // namespace

StaticCurve static_curve(const TrimmedGyro& gyro, const CurveGrid& grid) {
  StaticCurve curve;
  curve.temperature = grid.temperatures();
  const Eigen::Index count = curve.temperature.size();
  for (Eigen::ArrayXd* column : {&curve.bias, &curve.quadrature,
                                 &curve.drive_frequency, &curve.drive_voltage})
    column->resize(count);
  LockPath path;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double T = curve.temperature(k) + kZeroCelsius;
    const ModalParameters modal = modal_at(gyro, T);
    const BeamSignal signal = beam_signal(gyro, modal, {}, path);
    const Output output = electronics_at(gyro, T).output(signal.demodulated);
    curve.bias(k) = output.rate / kDegree;
    curve.quadrature(k) = output.quadrature / kDegree;
    curve.drive_frequency(k) = signal.drive_frequency / (2 * std::numbers::pi);
    curve.drive_voltage(k) = signal.drive_voltage;
  }
  return curve;
}

CurveLimits curve_limits(const StaticCurve& curve,
                         const DeviceParameters& device) {
  return {(curve.drive_voltage.abs() >= device.drive.voltage_limit).any(),
          (curve.bias.abs() > device.readout.full_scale / kDegree).any()};
}

Eigen::ArrayXd scale_factor_curve(const TrimmedGyro& gyro,
                                  const CurveGrid& grid) {
  Eigen::ArrayXd slope = grid.temperatures();
  for (double& value : slope) {
    const double T = value + kZeroCelsius;
    value = rate_slope(gyro, modal_at(gyro, T), T);
  }
  return slope;
}

double warm_up_change(const TrimmedGyro& gyro, double ambient) {
  const double T = ambient + kZeroCelsius;
  const NodeVector settled = settled_temperatures(gyro, T);
  return bias_at(gyro, settled(kBeam), settled(kBoard)) - bias_at(gyro, T, T);
}

Eigen::ArrayXd settled_residual(const FittedCompensator& compensator,
                                const DeviceParameters& device,
                                const StaticCurve& curve) {
  const std::vector<double> rate =
      compensated_rate(compensator, settled_recording(device, curve));
  Eigen::ArrayXd residual(curve.temperature.size());
  for (Eigen::Index k = 0; k < residual.size(); ++k)
    residual(k) = rate[static_cast<std::size_t>(kSamples * (k + 1) - 1)];
  return residual;
}

std::span<const FigureOfMerit> figures_of_merit() { return kFigures; }

const FigureOfMerit& figure_of_merit(Merit merit) {
  return kFigures[static_cast<std::size_t>(merit)];
}

const FigureOfMerit* find_figure_of_merit(std::string_view name) {
  const auto* const found = std::ranges::find_if(
      kFigures, [&](const FigureOfMerit& each) { return name == each.name; });
  return found == kFigures.end() ? nullptr : found;
}

std::vector<double> device_merits(const DeviceParameters& device,
                                  std::span<const Merit> merits,
                                  const MeritOptions& options,
                                  CurveLimits* limits) {
  MeritsOf merits_of(device, options);
  std::vector<double> values;
  for (const Merit merit : merits) values.push_back(merits_of(merit));
  if (limits != nullptr && merits_of.known_curve())
    *limits = curve_limits(*merits_of.known_curve(), device);
  return values;
}

}  // namespace beamgyro::internal
