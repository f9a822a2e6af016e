// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "sim/device/device.h"
#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Temperatures at which a curve is computed, evenly from `low` to `high`
/// [degC].
struct CurveGrid {
  double low = -40, high = 50;  // [degC]
  int count = 37;

  Eigen::ArrayXd temperatures() const {
    return Eigen::ArrayXd::LinSpaced(count, low, high);
  }
};

/// The settled state of a gyro at rest over temperature, beam and board at the
/// same one, free of noise: what `characterise` tabulates.
struct StaticCurve {
  Eigen::ArrayXd temperature;      // [degC]
  Eigen::ArrayXd bias;             // [deg/s]
  Eigen::ArrayXd quadrature;       // [deg/s]
  Eigen::ArrayXd drive_frequency;  // [Hz]
  Eigen::ArrayXd drive_voltage;    // [V]
};

/// Throws SimulationFailure where the drive loop does not lock.
StaticCurve static_curve(const TrimmedGyro& gyro, const CurveGrid& grid);

/// Returns the scale factor relative to that at T_0 at each temperature of the
/// grid (rate_slope()). Throws as static_curve().
Eigen::ArrayXd scale_factor_curve(const TrimmedGyro& gyro,
                                  const CurveGrid& grid);

/// Returns the bias [deg/s] of the settled gyro at `ambient` [degC] in still
/// air less that at power-on, when every part is at ambient: the change of an
/// hour's warm-up by self-heating. With an oven it holds the mount at its set
/// point then. Throws as static_curve(), and when the temperatures do not
/// settle.
double warm_up_change(const TrimmedGyro& gyro, double ambient);

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

/// Where the curve of a device is not what its user would see.
struct CurveLimits {
  bool is_limited = false;    // the drive is at its voltage limit
  bool is_saturated = false;  // the bias is beyond the full scale
};
CurveLimits curve_limits(const StaticCurve& curve,
                         const DeviceParameters& device);

/// Returns the figures of one device in the order of `merits`, from the static
/// solution. Where these need its curve, `limits` gets what it meets. Only what
/// they need is computed. Throws
/// - SimulationFailure for a device that does not work: the drive loop does not
///   lock, a passive material would have gains, temperatures do not settle;
/// - std::invalid_argument for a compensator with an input that a settled gyro
///   does not have.
std::vector<double> device_merits(const DeviceParameters& device,
                                  std::span<const Merit> merits,
                                  const MeritOptions& options,
                                  CurveLimits* limits = nullptr);

}  // namespace beamgyro::internal
