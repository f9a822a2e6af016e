// SPDX-License-Identifier: MIT
/// \file
/// Allan deviations and noise coefficients of a rate.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "beamgyro/progress.h"
#include "beamgyro/recording.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

struct AllanOptions {
  /// Of adev, oadev, mdev, hdev, ohdev, totdev (docs/guide/allan_deviation.md).
  std::vector<std::string> kinds = {"adev", "oadev"};
  std::string taus = "octave";  ///< or "decade", "all"
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  Progress progress = {};
};

/// A deviation at one averaging time.
struct DeviationPoint {
  double tau;            ///< [s]
  double deviation;      ///< in the unit of the rate
  double lower, upper;   ///< interval of 95 %
  std::size_t clusters;  ///< averages over tau that share no sample
};

struct DeviationCurve {
  std::string kind;  ///< "oadev", ...
  std::vector<DeviationPoint> points;
};

/// A term of IEEE 952: Q, N, B, K or R.
struct NoiseCoefficient {
  char symbol;
  std::string name;            ///< "angle random walk"
  double value, lower, upper;  ///< in seconds, with its interval of 95 %
  std::string unit;            ///< deg/sqrt(s), ...
  double per_hour;             ///< the value in hours
  std::string unit_per_hour;   ///< deg/sqrt(h), ...
};

struct AllanResult {
  std::string unit;  ///< of the deviations: deg/s for a rate
  std::vector<DeviationCurve> curves;
  std::vector<NoiseCoefficient> coefficients;  ///< those that the curve shows
  std::vector<std::string> warnings;
  std::string text;  ///< what `beamgyro allan` prints
  std::string json;  ///< what `--json` writes
};

/// Computes the deviations of a column of a recording. Samples without power
/// and gaps are left out. Throws std::invalid_argument for a column that is not
/// there, an unknown kind, an empty window, a series that is too short, times
/// that do not increase or are not even, a sample rate beyond 1e-9 to 1e9 Hz
/// and a value beyond +-1e12, and Cancelled.
AllanResult allan(const Recording& recording,
                  const std::string& column = "rate",
                  const AllanOptions& options = {});

/// The same for even samples, `rate_Hz` of them a second, in any unit.
AllanResult allan(std::span<const double> samples, double rate_Hz,
                  const std::string& unit = "deg/s",
                  const AllanOptions& options = {});

/// What a file of samples does not state.
struct AllanFileOptions {
  std::optional<std::string> column = {};  ///< "rate" without
  std::optional<double> rate_Hz = {};      ///< of a CSV without times
  std::optional<std::string> unit = {};    ///< of a CSV
};

/// The same for a recording, or a CSV of samples, as `beamgyro allan` does.
AllanResult allan_of_file(const std::filesystem::path& file,
                          const AllanFileOptions& about = {},
                          const AllanOptions& options = {});

}  // namespace beamgyro
