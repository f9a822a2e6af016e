// SPDX-License-Identifier: MIT
/// \file
/// Device files from the figures of a data sheet.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "beamgyro/device.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// Figures of a data sheet, each optional (docs/guide/smaller_gyro.md). The
/// unit is the end of the name.
struct DataSheet {
  std::optional<double> length = {};        ///< of the beam [m]
  std::optional<double> side = {};          ///< of its section [m]
  std::optional<double> frequency_Hz = {};  ///< of the drive at 25 degC
  std::optional<double> split_Hz = {};      ///< sense less drive mode there
  std::optional<double> quality = {};       ///< Q of the drive mode there
  std::optional<double> air_quality = {};   ///< Q that the gas alone leaves
  std::string mount = {};                   ///< "elastomer", "epoxy" or "metal"

  std::optional<double> range_deg_per_s = {};       ///< that is specified, +-
  std::optional<double> full_scale_deg_per_s = {};  ///< that clips, +-
  std::optional<double> scale_factor_V_per_deg_per_s = {};
  std::optional<double> bandwidth_Hz = {};                 ///< -3 dB
  std::optional<double> noise_deg_per_s_per_sqrt_Hz = {};  ///< one-sided
  std::optional<double> walk_deg_per_sqrt_h = {};    ///< the same, as a walk
  std::optional<double> instability_deg_per_h = {};  ///< least Allan deviation
  std::optional<double> null_deg_per_s = {};         ///< limit, +-
  std::optional<double> scale_tolerance_percent = {};  ///< limit, +-
  std::optional<int> adc_bits = {};

  std::optional<int> bits = {};  ///< of the temperature sensor
  std::optional<std::pair<double, double>> sensor_range_degC = {};
  std::optional<double> resolution_K = {};        ///< of the sensor
  std::optional<double> sensor_tolerance_K = {};  ///< limit, +-

  std::optional<double> supply_V = {};
  std::optional<double> current_A = {};
  std::optional<double> power_W = {};
  std::optional<double> self_heating_K = {};  ///< of the sensor, still air
  std::optional<double> warm_up_s = {};       ///< to 95 % of that
  /// In which the unit works; -40 to 50 without.
  std::optional<std::pair<double, double>> temperature_degC = {};
};

/// A figure that was asked for, and what the program measures of the device.
struct DesignFigure {
  std::string name, unit;
  double asked, measured;
  double tolerance;  ///< relative, within which it is met
  bool is_met() const;
};

struct DesignedDevice {
  std::string text;  ///< a device file; each key says where it comes from
  std::vector<DesignFigure> figures;  ///< those that can be measured
  std::vector<std::string> warnings;
};

/// Returns the device of a data sheet: `base` with its lengths scaled, and with
/// what makes it meet the figures. It is loaded and measured. Throws
/// std::invalid_argument
/// - for a figure out of its range, and for figures that contradict each other;
/// - for a base whose file has a value on several lines;
/// - for a quality factor that the parts of the gyro cannot have.
DesignedDevice design_device(const Device& base, const DataSheet& sheet);

}  // namespace beamgyro
