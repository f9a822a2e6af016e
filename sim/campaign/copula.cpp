// SPDX-License-Identifier: MIT
#include "sim/campaign/copula.h"

#include <algorithm>
#include <stdexcept>

#include "linear_algebra/cholesky.h"
#include "random/random_stream.h"
#include "sim/campaign/distribution.h"

namespace beamgyro::internal {

Eigen::MatrixXd correlation_factor(const Eigen::MatrixXd& correlation) {
  if (correlation != correlation.transpose() ||
      (correlation.diagonal().array() != 1).any()) {
    throw std::invalid_argument(
        "not symmetric with ones on the diagonal; expected a correlation "
        "matrix");
  }
  const Cholesky factor(correlation);
  if (!factor.is_positive_definite() ||
      (factor.lower().diagonal().array() < 1e-6).any()) {
    throw std::invalid_argument(
        "not positive definite; no numbers are correlated so");
  }
  return factor.lower();
}

void correlate(const CorrelatedGroup& group, std::span<double> numbers) {
  Eigen::VectorXd z(group.factor.rows());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    z(i) = normal_quantile(numbers[group.members[static_cast<std::size_t>(i)]]);
  }
  const Eigen::VectorXd correlated = group.factor * z;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    numbers[group.members[static_cast<std::size_t>(i)]] =
        std::clamp(normal_cumulative(correlated(i)), 0x1p-53, 1 - 0x1p-53);
  }
}

}  // namespace beamgyro::internal
