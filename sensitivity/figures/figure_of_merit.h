// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "sensitivity/figures/static_curve.h"
#include "sim/device/device.h"

namespace beamgyro::internal {

/// Returns what is left of the bias [deg/s] at each temperature of `curve` when
/// `compensator` works on a gyro that has settled there: its low-passes have
/// ended and its warm-up is over. The sensor shows the temperature of the beam
/// and its offset, without noise and resolution; the other signals are those of
/// the curve. Throws std::invalid_argument naming an input that is not among
/// them.
Eigen::ArrayXd settled_residual(const FittedCompensator& compensator,
                                const DeviceParameters& device,
                                const StaticCurve& curve);

enum class Merit {
  kBiasPeakToPeak,
  kCubicRms,
  kScaleFactorDrift,
  kWarmUpChange,
  kQuadrature,
  kCompensatorRms,
};

/// A number that says how good a device is, the smaller the better; where it
/// may be negative, its magnitude.
struct FigureOfMerit {
  Merit merit;
  const char* name;  // as on the command line, ends in the unit
  const char* unit;
  const char* what;
  bool is_positive;  // its logarithm is studied
};

/// All figures in the order of Merit. docs/sensitivity.md defines them.
std::span<const FigureOfMerit> figures_of_merit();

const FigureOfMerit& figure_of_merit(Merit merit);
/// Returns the figure of that name, or nullptr.
const FigureOfMerit* find_figure_of_merit(std::string_view name);

struct MeritOptions {
  CurveGrid grid;
  double ambient = 25;  // [degC], of the warm-up
  // For kCompensatorRms; what it does on settled samples.
  std::shared_ptr<const FittedCompensator> compensator;
};

/// Returns the figures of one device in the order of `merits`, from the static
/// solution. Only what they need is computed. Throws
/// - SimulationFailure for a device that does not work: the drive loop does not
///   lock, a passive material would have gains, temperatures do not settle;
/// - std::invalid_argument for a compensator with an input that a settled gyro
///   does not have.
std::vector<double> device_merits(const DeviceParameters& device,
                                  std::span<const Merit> merits,
                                  const MeritOptions& options);

}  // namespace beamgyro::internal
