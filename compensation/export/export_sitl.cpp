// SPDX-License-Identifier: MIT
#include "compensation/export/export_sitl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/export/parameter_lines.h"
#include "compensation/models/polynomial.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;

constexpr double kDefaultTimeConstant = 300;  // [s], SIM_IMUT_TCONST
constexpr std::size_t kLeastSamples = 10;

ArrayXd array_of(std::span<const double> values) {
  return Eigen::Map<const ArrayXd>(values.data(),
                                   static_cast<Eigen::Index>(values.size()));
}

// Returns (X.1) with the best ends for one time constant: a straight line in
// e^{-t/tau}.
WarmUpFit fit_ends(const ArrayXd& t, const ArrayXd& T, double tau) {
  const ArrayXd e = (-t / tau).exp();
  const ArrayXd d = e - e.mean();
  const double slope = (d * (T - T.mean())).sum() / d.square().sum();
  WarmUpFit fit{
      .start = 0, .end = T.mean() - slope * e.mean(), .time_constant = tau};
  fit.start = fit.end + slope;
  const ArrayXd left = T - (fit.end + slope * e);
  fit.rms = std::sqrt(left.square().mean());
  fit.largest = left.abs().maxCoeff();
  return fit;
}

}  // namespace

WarmUpFit fit_warm_up(std::span<const double> times,
                      std::span<const double> temperatures) {
  if (times.size() < kLeastSamples || times.size() != temperatures.size())
    throw std::invalid_argument(
        fmt::format("{} samples of a warm-up; expected {} or more",
                    times.size(), kLeastSamples));
  const ArrayXd t = array_of(times), T = array_of(temperatures);
  if (T.maxCoeff() - T.minCoeff() < kLeastRise) {
    const ArrayXd left = T - T.mean();
    return {T.mean(), T.mean(), kDefaultTimeConstant,
            std::sqrt(left.square().mean()), left.abs().maxCoeff()};
  }
  // The residual has one minimum over the logarithm of tau, within the grid
  // step that is lowest: a coarse search, then one by sections.
  constexpr int kSteps = 60, kSections = 60;
  const double first = std::log(t(1) - t(0));
  const double last = std::log(100 * (t(t.size() - 1) - t(0)));
  const auto rms_at = [&](double logarithm) {
    return fit_ends(t, T, std::exp(logarithm)).rms;
  };
  const double step = (last - first) / kSteps;
  double best = first;
  for (int k = 1; k <= kSteps; ++k)
    if (rms_at(first + k * step) < rms_at(best)) best = first + k * step;
  double low = best - step, high = best + step;
  for (int k = 0; k < kSections; ++k) {
    const double third = (high - low) / 3;
    if (rms_at(low + third) < rms_at(high - third))
      high -= third;
    else
      low += third;
  }
  return fit_ends(t, T, std::exp(0.5 * (low + high)));
}

double warm_up_temperature(const WarmUpFit& fit, double t) {
  return fit.end - (fit.end - fit.start) * std::exp(-t / fit.time_constant);
}

BiasModel disturbance_cubic(std::span<const double> temperatures,
                            std::span<const double> bias) {
  const ArrayXd T = array_of(temperatures);
  const Scale scale = scale_to_unit(T, "temperatures of the gyro");
  const ArrayXd x = (T - scale.centre) / scale.half_width;
  return {{scale}, {}, fit_polynomial(x, array_of(bias), 3)};
}

std::string sitl_parameters(const std::vector<AutopilotAxis>& axes,
                            const AutopilotGyro& gyro,
                            const std::optional<WarmUpFit>& warm_up,
                            const std::vector<std::string>& remarks) {
  require_ardupilot_gyro(gyro);
  const TemperatureRange range = ardupilot_range(axes);
  const int n = gyro.instance;
  // As SITL computes it, so that the coefficients belong to the value that it
  // uses.
  const auto middle = static_cast<float>(
      0.5 * static_cast<double>(static_cast<float>(range.highest) +
                                static_cast<float>(range.lowest)));
  std::string text =
      parameter_heading("ArduPilot SITL: bias over temperature", axes) + "\n";
  for (const std::string& remark : remarks) text += "# " + remark + "\n";
  const std::string prefix = fmt::format("SIM_IMUT{}_", n);
  add_line(text, prefix + "ENABLE", "1");
  add_line(text, prefix + "TMIN", single_precision(range.lowest));
  add_line(text, prefix + "TMAX", single_precision(range.highest));
  for (std::size_t k = 1; k < kCubicTerms; ++k)
    for (const char axis : kAutopilotAxes)
      add_line(text, fmt::format("{}GYR{}_{}", prefix, k, upper_axis(axis)),
               single_precision(
                   1e6 * cubic_coefficients(axes, axis,
                                            static_cast<double>(middle))[k]));
  for (const char axis : kAutopilotAxes)
    add_line(text, fmt::format("SIM_GYR{}_BIAS_{}", n, upper_axis(axis)),
             single_precision(cubic_coefficients(
                 axes, axis, static_cast<double>(middle))[0]));
  if (!warm_up) return text;
  add_line(text, "SIM_IMUT_START", single_precision(warm_up->start));
  add_line(text, "SIM_IMUT_END", single_precision(warm_up->end));
  add_line(text, "SIM_IMUT_TCONST", single_precision(warm_up->time_constant));
  add_line(text, "SIM_IMUT_FIXED", "0");
  return text;
}

}  // namespace beamgyro::internal
