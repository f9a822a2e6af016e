// SPDX-License-Identifier: MIT
#include "compensation/models/lookup_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "compensation/firmware/runtime.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {

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

nlohmann::ordered_json LookupTable::parameters() const {
  return {{"temperatures_degC", numbers_json(temperatures)},
          {"values_deg_per_s", numbers_json(values)}};
}

LookupTable LookupTable::read(const JsonNode& node, std::size_t) {
  return read_lookup_table(node, "values_deg_per_s");
}

void LookupTable::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"temperatures", "[degC]", singles(temperatures)});
  arrays.add({"values", "[deg/s]", singles(values)});
}

float LookupTable::firmware_value(const FirmwareArrays& arrays,
                                  std::span<const float> x) const {
  return runtime::table_at(arrays.data("temperatures"), arrays.data("values"),
                           arrays.count("values"), x[0]);
}

FirmwareCode LookupTable::firmware_code(std::size_t) const {
  return {{"table"},
          fmt::format("  return table_at(temperatures, values, {}, x[0]);\n",
                      values.size())};
}

LookupTable read_lookup_table(const JsonNode& node, const std::string& values) {
  LookupTable table{read_array(node.at("temperatures_degC")),
                    read_array(node.at(values))};
  const Eigen::Index n = table.temperatures.size();
  if (n < 1 || table.values.size() != n)
    node.at(values).fail(
        fmt::format("{} values for {} temperatures, must be as many and at "
                    "least 1",
                    table.values.size(), n));
  if (!(table.temperatures.tail(n - 1) > table.temperatures.head(n - 1)).all())
    node.at("temperatures_degC").fail("must increase");
  return table;
}

}  // namespace beamgyro::internal
