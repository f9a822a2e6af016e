// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace beamgyro::internal {

/// A Sobol' index with its interval of 95 %.
struct IndexEstimate {
  double value = 0, low = 0, high = 0;  // [-]
};

/// How often an estimate is made again from resampled values for its interval.
inline constexpr std::size_t kResamples = 400;

/// Returns `value` with the interval of 95 % of its replicates: their 2.5 and
/// 97.5 percentiles (Efron, 1979). Replicates that are not finite do not count;
/// without any the interval is `value`.
IndexEstimate with_interval(double value, std::vector<double> replicates);

/// Values of a function f of independent factors at the rows of A and of B, two
/// samples that are independent of each other, and of AB_i for each factor i,
/// which is A with factor i as in B. Rows correspond. NaN is a row without a
/// value.
struct PickFreezeValues {
  std::vector<double> a, b;
  std::vector<std::vector<double>> ab;  // one for each factor
};

struct FactorIndices {
  IndexEstimate first, total;
  double total_by_product = 0;  // second estimator of the total index
  std::size_t rows = 0;         // with all values that the indices need
};

struct PickFreezeIndices {
  std::size_t rows = 0;           // with a value in both A and B
  double mean = 0, variance = 0;  // of f, over these rows of A and of B
  std::vector<FactorIndices> factors;
};

/// Estimates the Sobol' indices of each factor. With the variance V of f, the
/// first-order index is the share of V that goes when the factor alone is
/// known, the total index the share that stays when all others are known:
///
///   S_i = V[E(f | x_i)] / V = mean f(B) (f(AB_i) - f(A)) / V
///   T_i = E[V(f | x_~i)] / V = mean (f(A) - f(AB_i))^2 / (2 V)
///
/// (Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, table 2 (b) and
/// (f); T_i is Jansen's, 1999). f counts from its mean. The second estimator
/// of T_i is mean f(A) (f(A) - f(AB_i)) / V (Sobol', 2007).
///
/// A row counts for V when f(A) and f(B) are there, for a factor when f(AB_i)
/// is there too. Intervals are those of rows that are drawn again with
/// replacement, the same for all factors (random stream kIndexResampleStream of
/// `seed`). They are those of independent rows: Sobol' points err less.
///
/// A function that does not vary, V <= 1e-20 mean^2 or fewer than two rows, has
/// indices of 0.
PickFreezeIndices pick_freeze_indices(const PickFreezeValues& values,
                                      std::uint64_t seed);

}  // namespace beamgyro::internal
