// SPDX-License-Identifier: MIT
#include "compensation/models/lookup_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace beamgyro {

using Eigen::Index;

double LookupTable::at(double temperature) const {
  const Index last = temperatures.size() - 1;
  if (!(temperature > temperatures(0))) return values(0);
  if (!(temperature < temperatures(last))) return values(last);
  const auto above =
      std::upper_bound(temperatures.begin(), temperatures.end(), temperature);
  const Index k = above - temperatures.begin();
  const double share = (temperature - temperatures(k - 1)) /
                       (temperatures(k) - temperatures(k - 1));
  return values(k - 1) + share * (values(k) - values(k - 1));
}

Eigen::ArrayXd LookupTable::predict(
    const Eigen::Ref<const Eigen::ArrayXd>& x) const {
  return x.unaryExpr([this](double T) { return at(T); });
}

LookupTable fit_lookup_table(const Eigen::Ref<const Eigen::ArrayXd>& x,
                             const Eigen::Ref<const Eigen::ArrayXd>& y,
                             double width) {
  if (!(width > 0.0) || x.size() == 0)
    throw std::invalid_argument(
        fmt::format("table: {} points in bins of {} K, must be points in bins "
                    "wider than 0",
                    x.size(), width));
  struct Bin {
    double count = 0.0, x = 0.0, y = 0.0;
  };
  std::map<double, Bin> bins;
  for (Index k = 0; k < x.size(); ++k) {
    Bin& bin = bins[std::floor(x(k) / width)];
    bin.count += 1.0;
    bin.x += x(k);
    bin.y += y(k);
  }
  const auto size = static_cast<Index>(bins.size());
  LookupTable table{Eigen::ArrayXd(size), Eigen::ArrayXd(size)};
  Index k = 0;
  for (const auto& [number, bin] : bins) {
    table.temperatures(k) = bin.x / bin.count;
    table.values(k++) = bin.y / bin.count;
  }
  return table;
}

}  // namespace beamgyro
