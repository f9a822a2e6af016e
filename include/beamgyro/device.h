// SPDX-License-Identifier: MIT
/// \file
/// Gyros: what a device file says, and the steady state that follows from it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "beamgyro/shared.h"
#include "beamgyro/value.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {
namespace internal {
struct DeviceState;
}

/// A file that was read.
struct InputFile {
  std::filesystem::path path;
  std::string text;  ///< byte for byte
};

/// A gyro, read from a device file (docs/reference/device_file.md) and checked.
/// Immutable; copies share their state, and many threads may use one at once.
class Device : public Shared<internal::DeviceState> {
 public:
  /// Reads a device file. `overrides` replace keys of it: KEY=VALUE with a
  /// dotted key and any TOML value, as "beam.length_m=0.041". Throws
  /// std::invalid_argument "file:line:column: key: ..." for what is wrong in
  /// the file, and OptionError "set KEY=VALUE: ..." for an override.
  static Device read(const std::filesystem::path& file,
                     const std::vector<std::string>& overrides = {});

  /// The same for a text in memory, called `name` in messages.
  static Device parse(const std::string& text,
                      const std::string& name = "device",
                      const std::vector<std::string>& overrides = {});

  /// Returns the device with further keys replaced. A key that was replaced
  /// before takes the new value. Throws as read().
  Device with(const std::vector<std::string>& overrides) const;
  /// The same for one key and a typed value, as "beam.length_m" and 0.041;
  /// override_of() makes overrides of several.
  Device with(std::string_view key, const Value& value) const;

  std::string text() const;                    ///< byte for byte as read
  std::string name() const;                    ///< of the file, in messages
  std::vector<std::string> overrides() const;  ///< in their order

  using Shared::Shared;
};

/// A quantity over the temperatures of a Characteristic.
struct CharacteristicColumn {
  std::string name;   ///< "bias", "drive_frequency", ...
  std::string units;  ///< as in recordings: degree/s, Hz, V; 1: a number
  std::vector<double> values;
};

/// Where a spurious mode meets the drive frequency, and the bump of the bias
/// there, to first order.
struct SpuriousCrossing {
  std::string mode;    ///< its name in the device file
  double temperature;  ///< [degC], of beam and housing
  double height;       ///< of the bump, signed [degree/s]
  double width;        ///< of the bump at half its height [K]
};

/// The steady state of a gyro at rest over the temperature of its beam, without
/// noise.
struct Characteristic {
  std::vector<double> temperature;  ///< [degC], of the beam
  /// bias, with its parts in_phase and quadrature [degree/s], drive_frequency
  /// and split of the modes [Hz], q_drive and q_sense [1], drive_voltage [V],
  /// scale_factor over that at the trim temperature [1].
  std::vector<CharacteristicColumn> columns;
  /// Between the least and the largest of the temperatures, by temperature.
  std::vector<SpuriousCrossing> crossings;
  std::vector<std::string> warnings;
  std::string csv;  ///< byte for byte what `beamgyro characterise` writes
};

/// Returns start, start + step, ... [degC] up to `stop`, and `stop` itself
/// where a step meets it. Throws std::invalid_argument for a number that is not
/// finite, a step that does not lead from start to stop, and more than
/// 1,000,000 temperatures.
std::vector<double> even_temperatures(double start, double stop, double step);

/// Computes the steady state at beam temperatures [degC], in their order.
/// Throws std::invalid_argument for none, for a temperature beyond -100 to
/// 150 degC or that is not finite, and std::runtime_error when the drive loop
/// cannot lock.
Characteristic characterise(const Device& device,
                            std::span<const double> temperatures_degC);

}  // namespace beamgyro
