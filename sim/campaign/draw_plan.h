// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_node.h"
#include "config/overrides.h"
#include "dataset/set/shard/shard.h"
#include "sim/campaign/distribution.h"
#include "sim/campaign/scrambled_sobol.h"
#include "sim/campaign/spurious_population.h"

namespace beamgyro::internal {

/// Numbers of one draw that are correlated by a Gaussian copula: z = L z',
/// correlation = L L^T, where each z is the normal quantile of a number.
struct CorrelatedGroup {
  std::vector<std::size_t> members;  // indices of the numbers
  Eigen::MatrixXd factor;            // L, lower
};

/// Returns the lower factor L of a correlation matrix. Throws
/// std::invalid_argument when it is not symmetric with ones on its diagonal and
/// positive definite.
Eigen::MatrixXd correlation_factor(const Eigen::MatrixXd& correlation);

/// Correlates the independent uniform numbers of the members of the group. Each
/// stays uniform.
void correlate(const CorrelatedGroup& group, std::span<double> numbers);

/// Returns the number of the stream called `name` (CRC-32 of ISO 3309).
std::uint32_t stream_number(std::string_view name);

/// The source of the uniform numbers of a campaign: a random stream for each
/// name, or the coordinates of Sobol' points.
struct UniformSource {
  std::uint64_t seed = 0;
  std::optional<ScrambledSobol> sobol;

  /// Returns a number in (0, 1). It depends on seed, device and stream alone,
  /// or on seed, device and dimension.
  double number(std::uint32_t device, std::uint32_t stream,
                std::size_t dimension) const;
};

/// One key of a device or scenario file that differs between devices.
struct Draw {
  std::vector<std::string> path;  // the key, split at its dots
  std::string place;              // of its distribution, "file:line:column"
  Distribution distribution;
  std::vector<ConfigNode> values;  // choices of a discrete one
  bool numeric = true;             // the parameter is the value, else its index
  std::size_t elements = 0;  // of an array, each drawn by itself; 0: one value
  // The key is the table of all spurious modes. `distribution` is that of their
  // number, `elements` the numbers that they take.
  std::optional<SpuriousPopulation> modes = {};

  std::size_t numbers() const { return elements == 0 ? 1 : elements; }
};

/// The dotted key.
std::string key_of(const Draw& draw);

/// Everything that is drawn for a device, or for one run of it.
struct DrawPlan {
  std::vector<Draw> draws;
  // One entry of each for each number, in the order of the draws.
  std::vector<DeviceVariable> parameters;
  std::vector<std::uint32_t> streams;
  std::size_t first_dimension = 0;  // of the Sobol' points
  std::vector<CorrelatedGroup> groups;
};

/// The drawn values of one device, in the order of the draws.
struct DrawnValues {
  std::vector<double> parameters;  // one per DrawPlan::parameters
  std::vector<ConfigNode> values;  // one per DrawPlan::draws
};

/// Returns what one number of a draw is called: its key, that of an element of
/// an array, or that of a spurious mode as "spurious_modes.1.detuning".
std::string number_key(const Draw& draw, std::size_t element);

/// Returns the value of one key for independent uniform numbers, one for each
/// element, and appends its parameters.
ConfigNode drawn_value(const Draw& draw, const double* uniform,
                       std::vector<double>& parameters);

DrawnValues drawn_values(const DrawPlan& plan, const UniformSource& source,
                         std::uint32_t device);

/// The same for given independent uniform numbers in (0, 1), one per
/// DrawPlan::parameters.
DrawnValues drawn_values(const DrawPlan& plan, std::vector<double> uniform);

/// Returns the values as overrides of the file that they belong to.
Overrides overrides_of(const DrawPlan& plan,
                       const std::vector<ConfigNode>& values);

/// Returns the unit that the end of a key names, spelled as in recordings:
/// "degree/s" for "offset_trim_deg_per_s", "1" when it names none.
std::string units_of(std::string_view key);

}  // namespace beamgyro::internal
