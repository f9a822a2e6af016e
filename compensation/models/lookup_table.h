// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

/// Values at given temperatures, with straight lines between them and the
/// outermost values beyond.
struct LookupTable {
  Eigen::ArrayXd temperatures;  // [degC], increasing, at least one
  Eigen::ArrayXd values;        // one each

  double at(double temperature) const;  // [degC]
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXd>& x) const;

  static constexpr const char* kKind = "table";
  static constexpr InputUse kInputUse = InputUse::kOne;
  nlohmann::ordered_json parameters() const;
  static LookupTable read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

/// Reads temperatures that increase under their key, and as many numbers under
/// the key `values`.
LookupTable read_lookup_table(
    const JsonNode& node, const std::string& values,
    const std::string& temperatures = "temperatures_degC");

/// Returns the means of temperature and value over the points of each bin [k
/// width, (k + 1) width) that has points. Throws std::invalid_argument without
/// points or for a width not above 0.
LookupTable fit_lookup_table(const Eigen::Ref<const Eigen::ArrayXd>& x,
                             const Eigen::Ref<const Eigen::ArrayXd>& y,
                             double width);

/// Returns a table with one entry for each soak, the mean of its points. Points
/// are of one soak if, sorted by x, no two neighbours are more than width / 4
/// apart. Throws std::invalid_argument as above, and when such points are
/// spread over more than `width`, as those of a ramp are.
LookupTable fit_table_at_soaks(const Eigen::Ref<const Eigen::ArrayXd>& x,
                               const Eigen::Ref<const Eigen::ArrayXd>& y,
                               double width);

}  // namespace beamgyro::internal
