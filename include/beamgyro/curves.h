// SPDX-License-Identifier: MIT
/// \file
/// The steady curves of a population over temperature, and the figures that
/// describe them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "beamgyro/campaign.h"
#include "beamgyro/device.h"
#include "beamgyro/progress.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// The steady states of the devices of a campaign at rest over the temperature
/// of their beams, without noise.
struct CampaignCurves {
  std::vector<double> temperature;     ///< [degC], m of them
  std::vector<std::uint32_t> devices;  ///< numbers of the n that work
  /// Those of a Characteristic. Values of a device stand together: n x m.
  std::vector<CharacteristicColumn> columns;
  std::vector<std::string> warnings;  ///< of devices that do not work, too
  std::string csv;                    ///< what `-o CURVES.csv` writes
};

struct CurveOptions {
  unsigned jobs = 0;       ///< threads; 0: one per core
  Progress progress = {};  ///< after each device
};

/// Computes the steady state of every device of a campaign at beam temperatures
/// [degC], in their order. The result does not depend on the number of threads.
/// A device that cannot be built or does not lock is left out, with a warning.
/// Throws std::invalid_argument for no temperature, one beyond -100 to 150 degC
/// and more than 10,000,000 temperatures of devices, std::runtime_error when no
/// device works, and Cancelled.
CampaignCurves characterise(const Campaign& campaign,
                            std::span<const double> temperatures_degC,
                            const CurveOptions& options = {});

/// Writes curves of a campaign: the bias of each device, a column each, to a
/// name that ends in .csv, all columns over device and temperature to one that
/// ends in .h5 (docs/reference/curves.md). The file appears when it is
/// complete. Throws std::invalid_argument for a name that cannot be written,
/// and std::runtime_error when writing fails.
void write_curves(const CampaignCurves& curves, const Campaign& campaign,
                  const std::filesystem::path& path);

/// How curves are treated before they are described.
struct CurveTreatment {
  std::optional<double> lowest_degC = {};   ///< of what counts; all without
  std::optional<double> highest_degC = {};  ///< of what counts; all without
  /// Each curve counts less its value there.
  std::optional<double> zero_at_degC = {};
  /// Values then count at the nearest multiple of it, as read from a drawing.
  std::optional<double> round_deg_per_s = {};
};

/// What describes a family of curves (docs/reference/curves.md).
struct CurveFigureResult {
  std::string text;  ///< what `beamgyro characterise` prints of them
  std::string json;  ///< what its `--json` writes
};

/// Describes curves [deg/s] over increasing temperatures [degC]; those of a
/// unit stand together, units x temperatures, `units` are their numbers.
/// `name` is what the text calls them. Throws std::invalid_argument for values
/// that are not finite, temperatures that do not increase, a range with fewer
/// than 8 of them, a zero beyond the temperatures, and no units.
CurveFigureResult curve_figures(std::span<const double> temperatures_degC,
                                std::span<const double> curves,
                                std::span<const std::uint32_t> units,
                                const CurveTreatment& treatment = {},
                                const std::string& name = "curves");

/// Returns the area between the distribution functions of two samples of a
/// figure, in its unit: the integral of |F - G|. Throws std::invalid_argument
/// for an empty sample and values that are not finite.
double area_metric(std::span<const double> one, std::span<const double> other);

/// Returns the mean distance between the quantiles of a sample and those of a
/// table over its shares, which increase within 0 to 1: two or more, with as
/// many values, which do not fall. Throws as above, and for another table.
double area_metric_of_table(std::span<const double> sample,
                            std::span<const double> shares,
                            std::span<const double> values);

/// The area metric between two random halves of one sample, over many splits.
struct HalfSplitDistance {
  double median, p95;
};

/// Throws std::invalid_argument for fewer than two values, for one that is not
/// finite, and for draws beyond 1 to 1,000,000.
HalfSplitDistance half_split(std::span<const double> sample,
                             std::size_t draws = 1000, std::uint64_t seed = 1);

}  // namespace beamgyro
