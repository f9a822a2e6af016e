// SPDX-License-Identifier: MIT
/// \file
/// Scenarios: what happens to a gyro over time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "beamgyro/device.h"
#include "beamgyro/shared.h"
#include "beamgyro/value.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {
namespace internal {
struct ScenarioState;
}

/// A scenario file (docs/reference/scenario_file.md) and the device that it is
/// about, read and checked. Immutable; copies share their state, and many
/// threads may use one at once.
class Scenario : public Shared<internal::ScenarioState> {
 public:
  /// Reads a scenario and the device that it names. `overrides` replace keys of
  /// either: KEY=VALUE with a dotted key and any TOML value, as "seed=2",
  /// "fidelity=\"carrier\"" or "beam.length_m=0.041". Throws
  /// std::invalid_argument "file:line:column: key: ..." for what is wrong in a
  /// file, and OptionError "set KEY=VALUE: ..." for an override.
  static Scenario read(const std::filesystem::path& file,
                       const std::vector<std::string>& overrides = {});

  /// The same with another device; the file that the scenario names is not
  /// read.
  static Scenario read(const std::filesystem::path& file, const Device& device,
                       const std::vector<std::string>& overrides = {});

  /// The same for texts in memory. The file that the scenario names as its
  /// device is not read. `name` is the name of the scenario in messages;
  /// profiles that the scenario names are relative to its folder. Those that
  /// are among `profiles` are not read.
  static Scenario parse(const std::string& text, const Device& device,
                        const std::vector<std::string>& overrides = {},
                        const std::string& name = "scenario",
                        const std::vector<InputFile>& profiles = {});

  /// Returns the scenario with further keys of it or of its device replaced. A
  /// key that was replaced before takes the new value. Profiles that were read
  /// before are not read again. Throws as read().
  Scenario with(const std::vector<std::string>& overrides) const;
  /// The same for one key and a typed value, as "beam.length_m" and 0.041;
  /// override_of() makes overrides of several.
  Scenario with(std::string_view key, const Value& value) const;

  /// Returns the scenario with another device, whose overrides go along; those
  /// of the scenario that are about a device are kept, and win.
  Scenario with_device(const Device& device) const;

  std::string text() const;  ///< byte for byte as read
  std::string name() const;  ///< of the file, in messages
  Device device() const;     ///< without the overrides of the scenario
  std::vector<std::string> overrides() const;  ///< in their order
  /// All files that were read.
  std::vector<std::filesystem::path> files() const;
  std::vector<InputFile> profiles() const;  ///< those among them

  std::string title() const;
  double duration() const;       ///< [s]
  double output_rate() const;    ///< [Hz]
  std::size_t samples() const;   ///< floor(duration output_rate)
  std::string fidelity() const;  ///< "quasistatic", "envelope" or "carrier"
  std::uint64_t seed() const;
  /// Estimated time of a carrier run here [s]; 0 for the other fidelities. For
  /// one of a minute or more its first second is simulated.
  double estimated_seconds() const;

  using Shared::Shared;
};

}  // namespace beamgyro
