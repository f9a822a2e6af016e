// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "sensitivity/figures/static_curve.h"
#include "sim/device/device.h"

namespace beamgyro::internal {

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
  std::shared_ptr<const Compensator> compensator;
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
