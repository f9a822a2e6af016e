// SPDX-License-Identifier: MIT
#include "tests/sensitivity/indices/sampled_function.h"

#include <cmath>
#include <numbers>

#include "random/random_stream.h"
#include "sim/campaign/scrambled_sobol.h"

namespace beamgyro::internal {

double ishigami(const std::vector<double>& u) {
  const auto x = [&](std::size_t i) {
    return std::numbers::pi * (2 * u[i] - 1);
  };
  return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) +
         0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

double g_function(const std::vector<double>& u) {
  double product = 1;
  for (std::size_t i = 0; i < u.size(); ++i)
    product *=
        (std::abs(4 * u[i] - 2) + kGImportance[i]) / (1 + kGImportance[i]);
  return product;
}

PickFreezeValues sampled(const UnitFunction& f, std::size_t dimensions,
                         std::size_t rows, std::uint64_t seed) {
  const ScrambledSobol sobol(2 * dimensions, seed);
  PickFreezeValues values;
  values.ab.resize(dimensions);
  for (std::uint32_t j = 0; j < rows; ++j) {
    std::vector<double> a(dimensions), b(dimensions);
    for (std::size_t n = 0; n < dimensions; ++n) {
      a[n] = sobol.at(j, n);
      b[n] = sobol.at(j, dimensions + n);
    }
    values.a.push_back(f(a));
    values.b.push_back(f(b));
    for (std::size_t n = 0; n < dimensions; ++n) {
      std::vector<double> ab = a;
      ab[n] = b[n];
      values.ab[n].push_back(f(ab));
    }
  }
  return values;
}

IndependentSample independent_sample(const UnitFunction& f,
                                     std::size_t dimensions, std::size_t rows,
                                     std::uint64_t seed) {
  IndependentSample sample;
  sample.numbers.resize(static_cast<Eigen::Index>(rows),
                        static_cast<Eigen::Index>(dimensions));
  for (std::uint32_t j = 0; j < rows; ++j) {
    RandomStream stream(seed, j, 0, kRankSampleStream);
    std::vector<double> u(dimensions);
    for (std::size_t n = 0; n < dimensions; ++n)
      sample.numbers(j, static_cast<Eigen::Index>(n)) = u[n] = stream.uniform();
    sample.values.push_back(f(u));
  }
  return sample;
}

}  // namespace beamgyro::internal
