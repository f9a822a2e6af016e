// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace beamgyro {

/// Values at given temperatures, with straight lines between them and the
/// outermost values beyond.
struct LookupTable {
  Eigen::ArrayXd temperatures;  // [degC], increasing, at least one
  Eigen::ArrayXd values;        // one each

  double at(double temperature) const;  // [degC]
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXd>& x) const;
};

/// Returns the means of temperature and value over the points of each bin [k
/// width, (k + 1) width) that has points. Throws std::invalid_argument without
/// points or for a width not above 0.
LookupTable fit_lookup_table(const Eigen::Ref<const Eigen::ArrayXd>& x,
                             const Eigen::Ref<const Eigen::ArrayXd>& y,
                             double width);

}  // namespace beamgyro
