// SPDX-License-Identifier: MIT
/// \file
/// Sets: the recordings of many gyros in one directory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "beamgyro/progress.h"
#include "beamgyro/recording.h"
#include "beamgyro/shared.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {
namespace internal {
class OpenSet;
}

/// What the data of a device are for.
enum class SetPart : std::uint8_t { kTrain, kValidation, kTest };

/// Returns "train", "validation", "test".
std::string_view part_name(SetPart part);

/// A number that was drawn for a device, or that one of its runs has.
struct DrawnParameter {
  std::string name, units, long_name;
  double value;
};

/// A run of a device that has no values.
struct SetFailure {
  std::string run;
  std::uint32_t device = 0;
  std::string reason;
};

/// A file of a set that is not as the manifest says.
struct SetDefect {
  std::string file;  ///< relative to the set
  std::string what;
};

/// The finished set of a campaign (docs/reference/set.md). Copies share their
/// state, and many threads may use one at once; HDF5 lets one in at a time.
class Set : public Shared<internal::OpenSet> {
 public:
  /// Opens the set in a directory. Throws std::invalid_argument when there is
  /// none, or when it is not finished.
  static Set open(const std::filesystem::path& directory);

  std::filesystem::path directory() const;
  std::string campaign() const;           ///< name of its file
  std::uint32_t devices() const;          ///< numbers from 0
  std::vector<std::string> runs() const;  ///< their names
  std::uint64_t seed() const;
  std::string program_version() const;
  std::string git_revision() const;
  std::vector<SetFailure> failures() const;

  /// Returns the part of a device. This and the next four throw
  /// std::invalid_argument for a run or device that the set does not have, and
  /// for a file with other bytes than the manifest says.
  SetPart part(std::uint32_t device) const;

  /// Returns the devices of a part, in order.
  std::vector<std::uint32_t> devices_of(SetPart part) const;

  /// Returns a run of a device in the units of recordings. Where `variables`
  /// are named, no other ones are read. Throws std::invalid_argument for a
  /// device that failed, with the reason.
  Recording recording(std::string_view run, std::uint32_t device,
                      const std::vector<std::string>& variables = {}) const;

  /// The same for the truths that are stored at a lower rate; without columns
  /// where there are none.
  Recording slow_recording(std::string_view run, std::uint32_t device) const;

  /// Returns the numbers that were drawn for a device in a run.
  std::vector<DrawnParameter> drawn_parameters(std::string_view run,
                                               std::uint32_t device) const;

  /// Compares every byte of the set with its manifest. Returns no defect for a
  /// set that is whole. Throws Cancelled.
  std::vector<SetDefect> verify(const Progress& progress = {}) const;

  using Shared::Shared;
};

}  // namespace beamgyro
